#include "bubblemesh/tet_complex.hpp"

#include <utility>

#include "crumble/base/memory.hpp"

namespace crumble {
namespace {

/// The two local corners p, q that make (i, j, p, q) an even order of 0 1 2 3.
constexpr std::array<std::array<std::array<std::uint8_t, 2>, 4>, 4> kRest{{
    {{{0, 0}, {2, 3}, {3, 1}, {1, 2}}},
    {{{3, 2}, {0, 0}, {0, 3}, {2, 0}}},
    {{{1, 3}, {3, 0}, {0, 0}, {0, 1}}},
    {{{2, 1}, {0, 2}, {1, 0}, {0, 0}}},
}};

std::size_t corner_of(const Tetrahedron& t, std::uint32_t v) {
  return static_cast<std::size_t>(std::ranges::find(t, v) - t.begin());
}

}  // namespace

TetComplex::TetComplex(std::size_t node_count, Vector<Tetrahedron> tetrahedra)
    : tets_(std::move(tetrahedra)), stars_(node_count) {
  for (TetId t = 0; t < tets_.size(); ++t) {
    for (const std::uint32_t v : tets_[t]) stars_[v].push_back(t);
  }
}

Vector<Tetrahedron> TetComplex::tetrahedra() const {
  Vector<Tetrahedron> result;
  for (TetId t = 0; t < tets_.size(); ++t) {
    if (alive(t)) result.push_back(tets_[t]);
  }
  return result;
}

bool TetComplex::has_edge(std::uint32_t a, std::uint32_t b) const {
  return std::ranges::any_of(stars_[a], [&](TetId t) { return holds(tets_[t], b); });
}

bool TetComplex::has_face(std::uint32_t a, std::uint32_t b, std::uint32_t c) const {
  return std::ranges::any_of(stars_[a], [&](TetId t) { return holds(tets_[t], b) && holds(tets_[t], c); });
}

TetId TetComplex::across(TetId t, int face) const {
  const auto& f = kTetFaces[face];
  const std::uint32_t a = tets_[t][f[0]], b = tets_[t][f[1]], c = tets_[t][f[2]];
  for (const TetId other : stars_[a]) {
    if (other != t && holds(tets_[other], b) && holds(tets_[other], c)) return other;
  }
  return kNoTet;
}

Ring TetComplex::ring(std::uint32_t a, std::uint32_t b) const {
  struct Link {
    std::uint32_t from, to;
    TetId tet;
  };
  std::array<Link, Ring::kMost> links;
  std::size_t count = 0;
  for (const TetId t : stars_[a]) {
    if (!holds(tets_[t], b)) continue;
    if (count == Ring::kMost) return {};
    const auto& rest = kRest[corner_of(tets_[t], a)][corner_of(tets_[t], b)];
    links[count++] = {tets_[t][rest[0]], tets_[t][rest[1]], t};
  }
  if (count == 0) return {};
  // begin where nothing leads to, if there is such a place
  const auto chain = std::span(links).first(count);
  for (std::size_t k = 0; k < count; ++k) {
    const bool reached = std::ranges::any_of(chain, [&](const Link& l) { return l.to == chain[k].from; });
    if (!reached) std::swap(chain[0], chain[k]);
  }
  for (std::size_t k = 1; k < count; ++k) {
    const auto next = std::ranges::find(chain.begin() + k, chain.end(), chain[k - 1].to, &Link::from);
    if (next == chain.end()) return {};
    std::swap(chain[k], *next);
  }
  Ring ring;
  ring.closed = chain[count - 1].to == chain[0].from;
  ring.size = ring.closed ? count : count + 1;
  if (ring.size > Ring::kMost) return {};
  for (std::size_t k = 0; k < count; ++k) {
    ring.vertices[k] = chain[k].from;
    ring.tets[k] = chain[k].tet;
  }
  if (!ring.closed) ring.vertices[count] = chain[count - 1].to;
  return ring;
}

void TetComplex::write(TetId slot, const Tetrahedron& t) {
  if (trial_) trial_->changes.push_back({slot, tets_[slot]});
  if (alive(slot)) {
    for (const std::uint32_t v : tets_[slot]) std::erase(stars_[v], slot);
  }
  tets_[slot] = t;
  if (alive(slot)) {
    for (const std::uint32_t v : t) stars_[v].push_back(slot);
  }
}

void TetComplex::replace(std::span<const TetId> out, std::span<const Tetrahedron> in) {
  for (const TetId t : out) {
    write(t, {});
    free_.push_back(t);
  }
  for (const Tetrahedron& t : in) {
    if (free_.empty()) {
      free_.push_back(static_cast<TetId>(tets_.size()));
      tets_.emplace_back();
    }
    const TetId slot = free_.back();
    free_.pop_back();
    write(slot, t);
  }
}

void TetComplex::begin_trial() {
  trial_ = Trial{{}, free_, tets_.size()};
}

Vector<TetId> TetComplex::new_in_trial() const {
  Vector<TetId> result;
  for (const Change& change : trial_->changes) {
    if (alive(change.slot)) result.push_back(change.slot);
  }
  std::ranges::sort(result);
  result.erase(std::unique(result.begin(), result.end()), result.end());
  return result;
}

void TetComplex::undo_trial() {
  const Trial trial = *std::exchange(trial_, std::nullopt);
  for (auto change = trial.changes.rbegin(); change != trial.changes.rend(); ++change)
    write(change->slot, change->before);
  tets_.resize(trial.slots);
  free_ = trial.free;
}

}  // namespace crumble
