// The unbroken body as a graph, and the parts that it is made of. Immutable, shared by all copies of a tracker.
#pragma once

#include <cstdint>
#include <span>

#include "crumble/base/memory.hpp"
#include "crumble/tetmesh/spring_graph.hpp"

namespace crumble {

struct FragmentGraph : SpringGraph {
  /// Throws what SpringGraph's constructor does.
  FragmentGraph(std::size_t node_count, std::span<const Edge> given_springs);

  Vector<std::uint32_t> parts;       // connected component of each node, numbered by least node (node_count)
  Vector<std::uint32_t> part_sizes;  // nodes of each
};

}  // namespace crumble
