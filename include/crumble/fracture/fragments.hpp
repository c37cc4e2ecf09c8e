// Fragments: the connected components of the spring network.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "crumble/base/memory.hpp"
#include "crumble/base/vec_array.hpp"
#include "crumble/tetmesh/tet_mesh.hpp"

namespace crumble {

/// In place of a fragment's id: there is none.
inline constexpr std::uint32_t kNoFragment = 0xffffffffu;

/// Finds the fragments of one body afresh; FragmentTracker keeps ids that last. `springs` is borrowed and must outlive
/// the labeler. One thread at a time.
class FragmentLabeler {
 public:
  FragmentLabeler(std::size_t node_count, std::span<const Edge> springs);

  /// Labels every node with its fragment. `intact` (spring_count; 1 or 0). Ids are dense and ordered by the fragments'
  /// least nodes, so node 0 is always in fragment 0; they depend on `intact` alone. Returns count(). No allocation.
  std::size_t label(std::span<const std::uint8_t> intact) noexcept;

  /// Fragment of each node (node_count), as the last label() found it; one fragment per node before the first.
  std::span<const std::uint32_t> labels() const noexcept { return labels_; }
  std::size_t count() const noexcept { return count_; }

 private:
  std::span<const Edge> springs_;
  Vector<std::uint32_t> parents_;
  Vector<std::uint32_t> labels_;
  std::size_t count_;
};

/// What a fragment is made of. A tetrahedron that lies in several fragments is shared out by corners: each node owns
/// its barycentric dual cell, a quarter of each of its tetrahedra. All zero for a fragment without nodes.
struct Fragment {
  std::uint32_t least_node = 0;
  std::uint32_t node_count = 0;
  std::uint32_t tetrahedron_count = 0;           // with all four corners in the fragment
  double rest_volume = 0;                        // m^3; over all fragments the body's volume
  double mass = 0;                               // kg
  Vec3 center = Vec3::Zero();                    // of mass, metres
  Vec3 velocity = Vec3::Zero();                  // of the center, m/s
  Mat3 inertia = Mat3::Zero();                   // of the nodes as points about the center, in scene axes, kg m^2
  Vec3 low = Vec3::Zero(), high = Vec3::Zero();  // corners of the box round the nodes, metres
};

/// Fills `fragments` (one place per id) from the labels (node_count; kNoFragment: skipped), the nodes' masses (kg,
/// node_count, positive), their positions now (metres) and velocities (m/s; may be empty: all zero). No allocation.
void measure_fragments(const TetMesh& mesh, std::span<const std::uint32_t> labels, std::span<const double> masses,
                       VecView positions, std::span<Fragment> fragments, VecView velocities = {}) noexcept;

/// The nodes and the whole tetrahedra of each fragment. For the reader's thread: no call allocates.
class FragmentLists {
 public:
  /// `mesh` is borrowed and must outlive the lists. Empty until the first update().
  explicit FragmentLists(const TetMesh& mesh);

  /// `labels` (node_count): ids below `fragment_count`, which is at most node_count, or kNoFragment.
  void update(std::span<const std::uint32_t> labels, std::size_t fragment_count) noexcept;

  /// Ascending; empty for an id that the last update() did not count. Valid until the next update().
  std::span<const std::uint32_t> nodes(std::uint32_t fragment) const noexcept { return nodes_.of(fragment); }
  /// Those with all four corners in the fragment.
  std::span<const std::uint32_t> tetrahedra(std::uint32_t fragment) const noexcept { return tetrahedra_.of(fragment); }

 private:
  // Items sorted by label, and where each label's begin.
  struct Lists {
    Lists(std::size_t item_count, std::size_t max_label_count);
    void sort(std::span<const std::uint32_t> labels, std::size_t count) noexcept;
    std::span<const std::uint32_t> of(std::uint32_t label) const noexcept;
    Vector<std::uint32_t> items, starts;
    std::size_t label_count = 0;
  };

  const TetMesh* mesh_;
  Vector<std::uint32_t> tetrahedron_labels_;  // kNoFragment: broken
  Lists nodes_, tetrahedra_;
};

}  // namespace crumble
