#include "open_springs.hpp"

#include <algorithm>
#include <cstring>

#include "crumble/fracture/fragments.hpp"
#include "crumble/fracture/masks.hpp"

namespace crumble {
namespace {

bool same_block(const std::uint8_t* a, const std::uint8_t* b) noexcept {
  std::uint64_t x, y;
  std::memcpy(&x, a, sizeof x);
  std::memcpy(&y, b, sizeof y);
  return x == y;
}

}  // namespace

OpenSprings::OpenSprings(const TetMesh& mesh, const SurfaceTopology& topology, SurfaceMode mode)
    : mesh_(mesh),
      topology_(topology),
      by_fragments_(mode == SurfaceMode::fragments),
      intact_(mesh.springs.size(), 1),
      closed_(by_fragments_ ? mesh.springs.size() : 0, 1),
      labels_(mesh.node_count(), 0),
      cuts_(mesh.springs.size()),
      dirty_(mesh.tetrahedra.size()) {}

void OpenSprings::reset(const SurfaceInput& now) noexcept {
  std::copy(now.intact.begin(), now.intact.end(), intact_.begin());
  std::copy(now.fragments.begin(), now.fragments.end(), labels_.begin());
  for (std::size_t s = 0; s < closed_.size(); ++s) {
    const auto [a, b] = mesh_.springs[s];
    closed_[s] = labels_[a] == labels_[b];
  }
  cuts_.clear();
  dirty_.clear();
}

bool OpenSprings::advance(const SurfaceInput& now) noexcept {
  cuts_.clear();
  dirty_.clear();
  return find_cuts(now.intact) && find_new_labels(now.fragments);
}

bool OpenSprings::find_cuts(std::span<const std::uint8_t> intact) noexcept {
  constexpr std::size_t kBlock = 8;
  for (std::size_t first = 0; first < intact.size(); first += kBlock) {
    const std::size_t end = std::min(first + kBlock, intact.size());
    if (end - first == kBlock && same_block(&intact[first], &intact_[first])) continue;
    for (std::size_t s = first; s < end; ++s) {
      if (intact[s] == intact_[s]) continue;
      if (intact[s] != 0) return false;
      intact_[s] = 0;
      cuts_.insert(static_cast<std::uint32_t>(s));
      if (!by_fragments_) open(static_cast<std::uint32_t>(s));
    }
  }
  return true;
}

bool OpenSprings::find_new_labels(std::span<const std::uint32_t> labels) noexcept {
  bool changed = false;
  for (std::size_t node = 0; node < labels.size(); ++node) {
    if (labels[node] == labels_[node]) continue;
    if (labels_[node] == kNoFragment) return false;
    changed = true;
    labels_[node] = labels[node];
    for (const std::uint32_t t : topology_.node_tetrahedra[node]) dirty_.insert(t);
  }
  return !changed || !by_fragments_ || find_partings();
}

// Springs whose ends are in different fragments now. Two removed ends have no fragments any more to tell apart; what
// is between them is not drawn, so it stays as it was.
bool OpenSprings::find_partings() noexcept {
  for (std::uint32_t s = 0; s < closed_.size(); ++s) {
    const auto [a, b] = mesh_.springs[s];
    const bool closed = labels_[a] == labels_[b];
    if (closed == (closed_[s] != 0) || (closed && labels_[a] == kNoFragment)) continue;
    if (closed) return false;
    closed_[s] = 0;
    open(s);
  }
  return true;
}

void OpenSprings::open(std::uint32_t spring) noexcept {
  for (const std::uint32_t t : topology_.spring_tetrahedra[spring]) dirty_.insert(t);
}

std::uint8_t OpenSprings::mask(std::size_t tetrahedron) const noexcept {
  return cut_mask(topology_.cells[tetrahedron].springs, by_fragments_ ? closed_ : intact_);
}

}  // namespace crumble
