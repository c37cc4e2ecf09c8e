// How far the matter around each node has turned.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "crumble/fracture/surface.hpp"

namespace crumble {

class NodeRotations {
 public:
  explicit NodeRotations(const TetMesh& mesh);

  /// From here on fit() sees these springs, and only nodes passed to use() are fitted.
  void start(std::span<const std::uint8_t> intact) noexcept;
  void use(std::uint32_t node) noexcept;
  /// Drops what is remembered of nodes that use() has not named since start().
  void forget_unused() noexcept;

  void fit(VecView positions) noexcept;
  /// Of a node in use, after fit().
  const Mat3& operator[](std::size_t node) const noexcept { return rotations_[node]; }

 private:
  struct Neighbor {
    std::uint32_t node;
    std::uint32_t spring;
    Vec3 offset;  // at rest
  };
  struct NodeState {
    bool used = false;    // by the surface as last extracted
    bool fitted = false;  // the rotation is one to remember
  };

  std::span<const Neighbor> neighbors(std::size_t node) const noexcept;
  Mat3 spread(std::size_t node, VecView positions, bool count_cut) const noexcept;

  std::vector<std::uint32_t> first_neighbor_;  // node_count + 1
  std::vector<Neighbor> neighbors_;
  std::vector<std::uint8_t> intact_;
  std::vector<NodeState> states_;
  std::vector<Mat3> rotations_;
};

}  // namespace crumble
