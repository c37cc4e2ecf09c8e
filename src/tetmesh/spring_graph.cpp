#include "crumble/tetmesh/spring_graph.hpp"

#include <numeric>
#include <string>

#include "crumble/base/error.hpp"

namespace crumble {
namespace {

void require_below(const char* field, std::size_t count, std::size_t limit) {
  if (count < limit) return;
  throw Error(Code::too_large,
              std::string(field) + " is " + std::to_string(count) + ", must be below " + std::to_string(limit));
}

void require_node(std::size_t spring, std::uint32_t node, std::size_t node_count) {
  if (node < node_count) return;
  throw Error(Code::out_of_range, "springs[" + std::to_string(spring) + "] ends at node " + std::to_string(node) +
                                      ", but node_count is " + std::to_string(node_count));
}

}  // namespace

SpringGraph::SpringGraph(std::size_t node_count, std::span<const Edge> given_springs)
    : springs(given_springs.begin(), given_springs.end()) {
  require_below("node_count", node_count, (std::size_t{1} << 32) - 1);
  require_below("spring_count", springs.size(), std::size_t{1} << 31);
  starts.resize(node_count + 1);
  neighbors.resize(2 * springs.size());
  springs_by_node.resize(2 * springs.size());
  for (std::size_t s = 0; s < springs.size(); ++s) {
    for (const std::uint32_t node : springs[s]) {
      require_node(s, node, node_count);
      ++starts[node];
    }
  }
  // counts become ends, and filling from the back makes them starts
  std::partial_sum(starts.begin(), starts.end(), starts.begin());
  for (auto s = static_cast<std::uint32_t>(springs.size()); s-- > 0;) {
    const auto [a, b] = springs[s];
    neighbors[--starts[a]] = b, springs_by_node[starts[a]] = s;
    neighbors[--starts[b]] = a, springs_by_node[starts[b]] = s;
  }
}

}  // namespace crumble
