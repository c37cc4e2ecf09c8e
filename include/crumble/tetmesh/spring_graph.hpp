// The springs as a graph: what hangs on each node. Immutable.
#pragma once

#include <cstdint>
#include <span>

#include "crumble/base/memory.hpp"
#include "crumble/tetmesh/tet_mesh.hpp"

namespace crumble {

struct SpringGraph {
  /// Throws Error: out_of_range (a spring's node), too_large (2^32 - 1 nodes, 2^31 springs).
  SpringGraph(std::size_t node_count, std::span<const Edge> given_springs);

  std::span<const std::uint32_t> neighbors_of(std::uint32_t node) const noexcept {
    return {neighbors.data() + starts[node], neighbors.data() + starts[node + 1]};
  }
  /// The springs that lead to them.
  const std::uint32_t* springs_of(std::uint32_t node) const noexcept { return springs_by_node.data() + starts[node]; }

  Vector<Edge> springs;
  Vector<std::uint32_t> starts;                      // of each node's neighbors (node_count + 1)
  Vector<std::uint32_t> neighbors, springs_by_node;  // by node, then by spring
};

}  // namespace crumble
