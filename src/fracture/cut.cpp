#include "crumble/fracture/cut.hpp"

#include "crumble/base/error.hpp"

namespace crumble {

std::vector<double> squared_length_limits(std::span<const double> rest_lengths, double length_limit) {
  require_in_range("length_limit", length_limit, 1, 1e6);
  std::vector<double> limits;
  limits.reserve(rest_lengths.size());
  for (const double rest_length : rest_lengths) {
    const double limit = length_limit * rest_length;
    limits.push_back(limit * limit);
  }
  return limits;
}

std::size_t cut_springs(VecView positions, std::span<const Edge> springs, std::span<const double> squared_limits,
                        std::span<std::uint8_t> intact, std::span<std::uint32_t> newly_cut) noexcept {
  std::size_t count = 0;
  for (std::size_t s = 0; s < springs.size(); ++s) {
    const auto [a, b] = springs[s];
    const double squared_length = squared_norm(positions[b] - positions[a]);
    // Without a branch to mispredict in a burst: the id is written always and counted only when the spring is cut.
    const unsigned is_cut = unsigned{squared_length > squared_limits[s]} & intact[s];
    newly_cut[count] = static_cast<std::uint32_t>(s);
    count += is_cut;
    intact[s] = static_cast<std::uint8_t>(intact[s] ^ is_cut);
  }
  return count;
}

}  // namespace crumble
