// How far the matter around each node has turned.
#pragma once

#include <cstdint>
#include <span>

#include "crumble/base/memory.hpp"
#include "crumble/base/vec_array.hpp"
#include "crumble/tetmesh/tet_mesh.hpp"
#include "surface_arrays.hpp"

namespace crumble {

class NodeRotations {
 public:
  /// What a cut does to a rotation shows within `settle` seconds.
  NodeRotations(const TetMesh& mesh, double settle);

  /// Forgets everything; these are the springs from here on.
  void reset(std::span<const std::uint8_t> intact) noexcept;

  /// The rotation of a node is fitted while more vertices use than drop it.
  void use(std::uint32_t node) noexcept;
  void drop(std::uint32_t node) noexcept { --uses_[node]; }

  /// Fits every node in use, and forgets the others.
  void fit(VecView positions, double time) noexcept;
  /// After fit(): a spring that was intact is cut. Shows nowhere before refit().
  void cut(std::uint32_t spring) noexcept;
  /// As of the moment of the last fit(): fits the nodes that have come into use since, and those whose springs have
  /// been cut; these begin to settle.
  void refit(VecView positions, double time) noexcept;

  /// Of a node in use, as last fitted. A rotation but for what has still to settle.
  const Mat3& operator[](std::size_t node) const noexcept { return drawn_[node]; }

 private:
  struct Neighbor {
    std::uint32_t node;
    std::uint32_t spring;
    Vec3 offset;  // at rest
  };
  struct Turn {
    Mat3 fit;      // to remember
    Mat3 offset;   // of what was drawn from the fit, when it was freed
    double freed;  // s
  };

  std::span<const Neighbor> neighbors(std::size_t node) const noexcept;
  bool has_cut(std::size_t node) const noexcept;
  Mat3 spread(std::size_t node, VecView positions, bool count_cut) const noexcept;
  void start_node(std::size_t node, VecView positions) noexcept;
  void fit_node(std::size_t node, VecView positions) noexcept;

  std::span<const Edge> springs_;
  double settle_;
  Vector<std::uint32_t> first_neighbor_;  // node_count + 1
  Vector<Neighbor> neighbors_;
  Vector<std::uint8_t> intact_;       // per spring
  Vector<std::uint32_t> uses_;        // per node
  Vector<std::uint8_t> started_;      // per node: there is a turn to remember
  UntouchedArray<Turn> turns_;        // per node
  UntouchedArray<Mat3> drawn_;        // per node: fit + what is left of the offset
  IndexSet new_nodes_, freed_nodes_;  // for refit()
};

}  // namespace crumble
