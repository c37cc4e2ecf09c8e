#include "fragment_graph.hpp"

#include "crumble/base/memory.hpp"
#include "crumble/fracture/fragments.hpp"

namespace crumble {

FragmentGraph::FragmentGraph(std::size_t node_count, std::span<const Edge> given_springs)
    : SpringGraph(node_count, given_springs) {
  FragmentLabeler labeler(node_count, springs);
  part_sizes.resize(labeler.label(Vector<std::uint8_t>(springs.size(), 1)));
  parts.assign(labeler.labels().begin(), labeler.labels().end());
  for (const std::uint32_t part : parts) ++part_sizes[part];
}

}  // namespace crumble
