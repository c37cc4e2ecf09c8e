#include "crumble/fracture/fragments.hpp"

#include <algorithm>
#include <numeric>

namespace crumble {
namespace {

std::uint32_t find_root(std::span<std::uint32_t> parents, std::uint32_t node) noexcept {
  while (parents[node] != node) {
    parents[node] = parents[parents[node]];
    node = parents[node];
  }
  return node;
}

}  // namespace

FragmentLabeler::FragmentLabeler(std::size_t node_count, std::span<const Edge> springs)
    : springs_(springs), parents_(node_count), labels_(node_count), count_(node_count) {
  std::iota(labels_.begin(), labels_.end(), 0u);
}

// Union-find in which the greater root always hooks under the smaller: a root is its fragment's least node, so one pass
// over the nodes in order meets every root before the nodes below it.
std::size_t FragmentLabeler::label(std::span<const std::uint8_t> intact) noexcept {
  std::iota(parents_.begin(), parents_.end(), 0u);
  for (std::size_t s = 0; s < springs_.size(); ++s) {
    if (intact[s] == 0) continue;
    const std::uint32_t a = find_root(parents_, springs_[s][0]);
    const std::uint32_t b = find_root(parents_, springs_[s][1]);
    parents_[std::max(a, b)] = std::min(a, b);
  }
  count_ = 0;
  for (std::uint32_t node = 0; node < parents_.size(); ++node) {
    const std::uint32_t parent = parents_[node];
    labels_[node] = parent == node ? static_cast<std::uint32_t>(count_++) : labels_[parent];
  }
  return count_;
}

void measure_fragments(const TetMesh& mesh, std::span<const std::uint32_t> labels, std::span<const double> masses,
                       VecView positions, std::span<Fragment> fragments) noexcept {
  std::fill(fragments.begin(), fragments.end(), Fragment{});
  for (std::uint32_t node = 0; node < labels.size(); ++node) {
    Fragment& fragment = fragments[labels[node]];
    if (fragment.node_count++ == 0) fragment.least_node = node;
    fragment.rest_volume += mesh.node_volumes[node];
    fragment.mass += masses[node];
    fragment.center += masses[node] * positions[node];
  }
  for (Fragment& fragment : fragments) fragment.center /= fragment.mass;
  for (const auto& [a, b, c, d] : mesh.tetrahedra) {
    const std::uint32_t label = labels[a];
    if (labels[b] == label && labels[c] == label && labels[d] == label) ++fragments[label].tetrahedron_count;
  }
}

}  // namespace crumble
