// The vertices that triangles use, and where they are.
//
// A vertex is a copy of a site (surface_patterns.hpp) on the cells of some nodes, its carriers. Its own place is the
// mean of where these put it, each keeping it where it was in its cell at rest: x_i + R_i (X - X_i).
//
// Nothing may jump at a cut. A cut makes vertices and takes carriers from vertices; both leave the drawn point where it
// was and write down how far that is from the vertex's new own place. This offset goes to zero linearly within the
// settling time. It is added to the own place of the moment, so what falls or flies does not lag behind.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "crumble/base/memory.hpp"
#include "crumble/base/vec_array.hpp"
#include "node_rotations.hpp"
#include "surface_arrays.hpp"
#include "surface_topology.hpp"

namespace crumble {

/// Nodes whose cells carry a vertex, ascending. While nothing is mended they only ever become fewer.
struct Carriers {
  std::array<std::uint32_t, 4> nodes;
  std::uint32_t count;
};

class VertexList {
 public:
  static constexpr std::uint32_t kNone = SurfaceTopology::kNone;

  /// `mesh` and `rotations` are borrowed. At most `bound` vertices; a freed one settles within `settle` seconds.
  VertexList(const TetMesh& mesh, NodeRotations& rotations, std::size_t slot_count, std::size_t bound, double settle);

  void clear() noexcept;
  /// The vertex in a slot, or kNone.
  std::uint32_t find(std::uint32_t slot) const noexcept { return slot_vertices_[slot]; }
  std::uint32_t carrier_count(std::uint32_t vertex) const noexcept { return carrier_counts_[vertex]; }
  bool is_carried_by(std::uint32_t vertex, const Carriers& carriers) const noexcept;

  /// A new vertex; its place is that of place().
  std::uint32_t add(std::uint32_t slot, const Carriers& carriers, const Vec3& rest) noexcept;
  /// A new vertex that is drawn at `start` until it settles.
  std::uint32_t add_freed(std::uint32_t slot, const Carriers& carriers, const Vec3& rest, const Vec3& start) noexcept;
  /// A new vertex that moves like `other`, which has the same carriers.
  std::uint32_t add_twin(std::uint32_t slot, std::uint32_t other) noexcept;
  /// The vertex has lost some of its carriers.
  void set_carriers(std::uint32_t vertex, const Carriers& carriers) noexcept;

  /// A triangle corner more or less on it.
  void retain(std::uint32_t vertex) noexcept { ++uses_[vertex]; }
  void release(std::uint32_t vertex) noexcept {
    if (--uses_[vertex] == 0) unused_.insert(vertex);
  }
  /// Removes vertices without a triangle. The last ones fill their places: `renamed(slot, from, to)` for each.
  template <class Renamed>
  void remove_unused(Renamed&& renamed) noexcept;

  /// Moves all vertices to where they are at `time`.
  void place(VecView positions, double time) noexcept;
  /// Those that have been freed since begin to settle: new ones, and set_carriers().
  void settle(VecView positions, double time) noexcept;

  std::size_t count() const noexcept { return count_; }
  std::size_t bound() const noexcept { return positions_.size(); }
  std::span<const Vec3> positions() const noexcept { return positions_.first(count_); }
  std::span<const Vec3> rest_positions() const noexcept { return rest_positions_.first(count_); }

  /// What has changed since it was last cleared: vertices with a new place at rest.
  IndexSet changed;

 private:
  struct Vertex {
    std::array<std::uint32_t, 4> carriers;
    std::uint32_t slot;
    double freed;  // time of the last cut that moved its own place
  };

  Vec3 own_place(std::size_t vertex, VecView positions) const noexcept;
  void forget(std::size_t vertex) noexcept;
  bool is_node(std::uint32_t slot) const noexcept { return slot < mesh_.node_count(); }

  const TetMesh& mesh_;
  NodeRotations& rotations_;
  double settle_;
  std::size_t count_ = 0;
  Vector<std::uint32_t> slot_vertices_;
  UntouchedArray<Vec3> positions_, rest_positions_;
  UntouchedArray<Vertex> vertices_;
  UntouchedArray<Vec3> offsets_;        // from its own place, when it was freed
  UntouchedArray<std::uint32_t> uses_;  // triangle corners on it
  UntouchedArray<std::uint8_t> carrier_counts_;
  IndexSet freed_;   // by the cuts of this update
  IndexSet unused_;  // or have been since the last remove_unused()
};

template <class Renamed>
void VertexList::remove_unused(Renamed&& renamed) noexcept {
  for (const std::uint32_t hole : unused_.items()) {
    while (count_ > 0 && uses_[count_ - 1] == 0) forget(--count_);
    if (hole >= count_ || uses_[hole] > 0) continue;
    forget(hole);
    const auto last = static_cast<std::uint32_t>(--count_);
    const std::uint32_t slot = vertices_[last].slot;
    positions_[hole] = positions_[last];
    rest_positions_[hole] = rest_positions_[last];
    vertices_[hole] = vertices_[last];
    offsets_[hole] = offsets_[last];
    uses_[hole] = uses_[last];
    carrier_counts_[hole] = carrier_counts_[last];
    slot_vertices_[slot] = hole;
    changed.insert(hole);
    renamed(slot, last, hole);
  }
  unused_.clear();
}

}  // namespace crumble
