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

namespace {

// Of a tetrahedron: the fragment that has all its corners, or kNoFragment.
std::uint32_t common_label(const Tetrahedron& tetrahedron, std::span<const std::uint32_t> labels) noexcept {
  const std::uint32_t label = labels[tetrahedron[0]];
  const bool whole = std::all_of(tetrahedron.begin() + 1, tetrahedron.end(),
                                 [&](std::uint32_t node) { return labels[node] == label; });
  return whole ? label : kNoFragment;
}

void add_node(const Vec3& position, Fragment& fragment) noexcept {
  if (fragment.node_count++ == 0) fragment.low = fragment.high = position;
  fragment.low = fragment.low.cwiseMin(position);
  fragment.high = fragment.high.cwiseMax(position);
}

}  // namespace

void measure_fragments(const TetMesh& mesh, std::span<const std::uint32_t> labels, std::span<const double> masses,
                       VecView positions, std::span<Fragment> fragments, VecView velocities) noexcept {
  std::fill(fragments.begin(), fragments.end(), Fragment{});
  for (std::uint32_t node = 0; node < labels.size(); ++node) {
    if (labels[node] == kNoFragment) continue;
    Fragment& fragment = fragments[labels[node]];
    if (fragment.node_count == 0) fragment.least_node = node;
    add_node(positions[node], fragment);
    fragment.rest_volume += mesh.node_volumes[node];
    fragment.mass += masses[node];
    fragment.center += masses[node] * positions[node];
    if (velocities.size() > 0) fragment.velocity += masses[node] * velocities[node];
  }
  for (Fragment& fragment : fragments) {
    if (fragment.node_count == 0) continue;
    fragment.center /= fragment.mass;
    fragment.velocity /= fragment.mass;
  }
  for (std::uint32_t node = 0; node < labels.size(); ++node) {
    if (labels[node] == kNoFragment) continue;
    Fragment& fragment = fragments[labels[node]];
    const Vec3 arm = positions[node] - fragment.center;
    fragment.inertia += masses[node] * (squared_norm(arm) * Mat3::Identity() - arm * arm.transpose());
  }
  for (const Tetrahedron& tetrahedron : mesh.tetrahedra) {
    const std::uint32_t label = common_label(tetrahedron, labels);
    if (label != kNoFragment) ++fragments[label].tetrahedron_count;
  }
}

FragmentLists::FragmentLists(const TetMesh& mesh)
    : mesh_(&mesh),
      tetrahedron_labels_(mesh.tetrahedra.size()),
      nodes_(mesh.node_count(), mesh.node_count()),
      tetrahedra_(mesh.tetrahedra.size(), mesh.node_count()) {}

void FragmentLists::update(std::span<const std::uint32_t> labels, std::size_t fragment_count) noexcept {
  nodes_.sort(labels, fragment_count);
  std::transform(mesh_->tetrahedra.begin(), mesh_->tetrahedra.end(), tetrahedron_labels_.begin(),
                 [&](const Tetrahedron& tetrahedron) { return common_label(tetrahedron, labels); });
  tetrahedra_.sort(tetrahedron_labels_, fragment_count);
}

FragmentLists::Lists::Lists(std::size_t item_count, std::size_t max_label_count)
    : items(item_count), starts(max_label_count + 2) {}

// Counting sort. Counts stand two places up, so that their sums are the starts one place up, and filling the lists
// moves each of those to the next list's start: it comes to stand where it belongs.
void FragmentLists::Lists::sort(std::span<const std::uint32_t> labels, std::size_t count) noexcept {
  label_count = count;
  std::fill_n(starts.begin(), count + 2, 0u);
  for (const std::uint32_t label : labels) {
    if (label != kNoFragment) ++starts[label + 2];
  }
  std::partial_sum(starts.begin(), starts.begin() + static_cast<std::ptrdiff_t>(count) + 2, starts.begin());
  for (std::uint32_t item = 0; item < labels.size(); ++item) {
    if (labels[item] != kNoFragment) items[starts[labels[item] + 1]++] = item;
  }
}

std::span<const std::uint32_t> FragmentLists::Lists::of(std::uint32_t label) const noexcept {
  if (label >= label_count) return {};
  return {items.data() + starts[label], items.data() + starts[label + 1]};
}

}  // namespace crumble
