// Fragments: the connected components of the spring network.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "crumble/base/vec_array.hpp"
#include "crumble/tetmesh/tet_mesh.hpp"

namespace crumble {

/// Finds the fragments of one body. `springs` is borrowed and must outlive the labeler.
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
  std::vector<std::uint32_t> parents_;
  std::vector<std::uint32_t> labels_;
  std::size_t count_;
};

/// What a fragment is made of. A tetrahedron that lies in several fragments is shared out by corners: each node owns
/// its barycentric dual cell, a quarter of each of its tetrahedra.
struct Fragment {
  std::uint32_t least_node = 0;
  std::uint32_t node_count = 0;
  std::uint32_t tetrahedron_count = 0;  // with all four corners in the fragment
  double rest_volume = 0;               // m^3; over all fragments the body's volume
  double mass = 0;                      // kg
  Vec3 center = Vec3::Zero();           // of mass, metres
};

/// Fills `fragments` (FragmentLabeler::count() places) from the labels, the nodes' masses (kg, node_count, positive)
/// and their positions now (metres). No allocation.
void measure_fragments(const TetMesh& mesh, std::span<const std::uint32_t> labels, std::span<const double> masses,
                       VecView positions, std::span<Fragment> fragments) noexcept;

}  // namespace crumble
