// The list of pairs that a step looks at: at least all that are nearer than the sum of their radii. It is kept by
// ball_search.hpp; when and with what margin changes no bit of the forces, since a pair that is not in the list has its
// full contact distance and does not touch.
#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "ball_contacts_impl.hpp"

namespace crumble {
namespace {

// The middle one of a few: one that flies off does not count.
double middle_of(std::span<const double> values) noexcept {
  std::array<double, 31> few{};
  for (std::size_t k = 0; k < few.size(); ++k) {
    const double value = values[values.size() * k / few.size()];
    few[k] = std::isfinite(value) ? value : 0;  // what is not a number has no order
  }
  std::nth_element(few.begin(), few.begin() + few.size() / 2, few.end());
  return few[few.size() / 2];
}

}  // namespace

void BallContacts::Impl::update_list(const VecView& positions, const VecView& velocities) noexcept {
  ++steps_since_search_;
  if (roster.changed() || search.dropped() > 0) return search_all(positions, velocities);
  search.drift(drift_);
  const bool many = !search.find_strays(positions);
  if (adapt_margin(many)) return search_all(positions, velocities);
  if (search.strays().empty()) return;
  search.search_strays(positions, admits());
  if (search.dropped() > 0 || pairs_.count + search.pairs().size() > pairs_.keys.size()) {
    return search_all(positions, velocities);
  }
  const auto is_paired = [&](std::uint32_t place) { return is_paired_[place] == 1; };
  if (search.pairs().empty() && std::none_of(search.strays().begin(), search.strays().end(), is_paired)) return;
  merge_pairs(positions);
}

// Whether all are to be searched for. That costs as much as some ten looks at the list, so in a lively heap it pays to
// look at more pairs.
bool BallContacts::Impl::adapt_margin(bool many_strays) noexcept {
  if (many_strays && steps_since_search_ < 8) next_margin_ = std::min(2 * next_margin_, most_margin());
  if (many_strays || steps_since_search_ < 128 || next_margin_ == least_margin()) return many_strays;
  next_margin_ = std::max(next_margin_ / 2, least_margin());
  return true;
}

void BallContacts::Impl::search_all(const VecView& positions, const VecView& velocities) noexcept {
  search.search_all(positions, radii_, idle_, next_margin_, admits());
  if (search.dropped() > 0) search.search_all(positions, radii_, idle_, 0, admits());
  steps_since_search_ = 0;
  ++searches;
  if (!roster.nodes().empty())
    drift_ = tau_ * Vec3(middle_of(velocities.x), middle_of(velocities.y), middle_of(velocities.z));
  if (roster.changed()) renumber_pairs();
  merge_pairs(positions);
}

// Pairs of nodes that no longer take part go.
void BallContacts::Impl::renumber_pairs() noexcept {
  constexpr std::uint32_t kGone = 0xffffffffu;
  const std::span<const std::uint32_t> nodes = roster.nodes();
  std::size_t now = 0;
  for (std::uint32_t& place : places_) {  // from nodes to what are their places now
    while (now < nodes.size() && nodes[now] < place) ++now;
    place = now < nodes.size() && nodes[now] == place ? static_cast<std::uint32_t>(now) : kGone;
  }
  std::size_t kept = 0;
  for (std::size_t k = 0; k < pairs_.count; ++k) {
    const BallPair pair(pairs_.keys[k]);
    const std::uint32_t first = places_[pair.first], second = places_[pair.second];
    if (first == kGone || second == kGone) continue;
    pairs_.copy(kept, pairs_, k);
    pairs_.keys[kept++] = BallPair::key(first, second);
  }
  pairs_.count = kept;
  places_.assign(nodes.begin(), nodes.end());
}

// Of balls that were searched for, the pairs are those found: what the old list remembers of them is taken over.
void BallContacts::Impl::merge_pairs(const VecView& positions) noexcept {
  constexpr std::uint64_t kNone = ~std::uint64_t{0};
  forget_contacts();
  std::swap(pairs_, old_pairs_);
  pairs_.count = 0;
  std::fill_n(is_paired_.begin(), places_.size(), std::uint8_t{0});
  const std::span<const std::uint64_t> found = search.pairs();
  std::size_t f = 0;
  const auto next = [&] { return f < found.size() ? found[f] : kNone; };
  for (std::size_t k = 0; k < old_pairs_.count; ++k) {
    const std::uint64_t key = old_pairs_.keys[k];
    while (next() < key) add_pair(found[f++], positions);
    const BallPair pair(key);
    if (next() == key) {
      ++f;
    } else if (search.is_renewed(pair.first) || search.is_renewed(pair.second)) {
      continue;
    }
    is_paired_[pair.first] = is_paired_[pair.second] = 1;
    pairs_.copy(pairs_.count++, old_pairs_, k);
  }
  while (f < found.size()) add_pair(found[f++], positions);
}

// Its contact distance: see ball_contacts.hpp.
void BallContacts::Impl::add_pair(std::uint64_t key, const VecView& positions) noexcept {
  const BallPair pair(key);
  const std::size_t k = pairs_.count++;
  const double sum = radii_[pair.first] + radii_[pair.second];
  const double distance = squared_norm(positions[pair.first] - positions[pair.second]);
  const bool is_old = !roster.changed() || roster.could_touch(places_[pair.first], places_[pair.second]);
  pairs_.keys[k] = key;
  pairs_.sum[k] = sum * sum;
  pairs_.reach[k] = is_old ? sum * sum : std::min(sum * sum, distance);
  pairs_.touched_at[k] = 0;
  is_paired_[pair.first] = is_paired_[pair.second] = 1;
}

}  // namespace crumble
