#include "crumble/fracture/cut.hpp"

namespace crumble {

std::size_t cut_springs(std::span<const std::uint32_t> overlong, std::span<std::uint8_t> intact,
                        std::span<std::uint32_t> newly_cut) noexcept {
  std::size_t count = 0;
  for (const std::uint32_t spring : overlong) {
    if (intact[spring] == 0) continue;
    intact[spring] = 0;
    newly_cut[count++] = spring;
  }
  return count;
}

}  // namespace crumble
