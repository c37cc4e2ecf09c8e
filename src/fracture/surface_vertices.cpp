#include "surface_vertices.hpp"

#include <algorithm>
#include <limits>

namespace crumble {
namespace {

constexpr std::array<double, 5> kShares{0, 1, 1.0 / 2, 1.0 / 3, 1.0 / 4};  // of each of so many carriers
constexpr double kLongAgo = -std::numeric_limits<double>::infinity();

}  // namespace

VertexList::VertexList(const TetMesh& mesh, NodeRotations& rotations, std::size_t slot_count, std::size_t bound,
                       double settle)
    : changed(bound),
      mesh_(mesh),
      rotations_(rotations),
      settle_(settle),
      slot_vertices_(slot_count, kNone),
      positions_(bound),
      rest_positions_(bound),
      vertices_(bound),
      offsets_(bound),
      uses_(bound),
      carrier_counts_(bound),
      freed_(bound),
      unused_(bound) {}

void VertexList::clear() noexcept {
  std::fill(slot_vertices_.begin(), slot_vertices_.end(), kNone);
  count_ = 0;
}

bool VertexList::is_carried_by(std::uint32_t vertex, const Carriers& carriers) const noexcept {
  const auto& nodes = vertices_[vertex].carriers;
  return carrier_counts_[vertex] == carriers.count &&
         std::equal(nodes.begin(), nodes.begin() + carriers.count, carriers.nodes.begin());
}

std::uint32_t VertexList::add(std::uint32_t slot, const Carriers& carriers, const Vec3& rest) noexcept {
  const auto v = static_cast<std::uint32_t>(count_++);
  slot_vertices_[slot] = v;
  rest_positions_[v] = rest;
  vertices_[v].carriers = carriers.nodes;
  vertices_[v].slot = slot;
  vertices_[v].freed = kLongAgo;
  uses_[v] = 0;
  carrier_counts_[v] = static_cast<std::uint8_t>(carriers.count);
  changed.insert(v);
  if (is_node(slot)) return v;  // it is where the node is, however that has turned
  for (std::size_t k = 0; k < carriers.count; ++k) rotations_.use(carriers.nodes[k]);
  return v;
}

std::uint32_t VertexList::add_freed(std::uint32_t slot, const Carriers& carriers, const Vec3& rest,
                                    const Vec3& start) noexcept {
  const std::uint32_t v = add(slot, carriers, rest);
  positions_[v] = start;
  freed_.insert(v);
  return v;
}

std::uint32_t VertexList::add_twin(std::uint32_t slot, std::uint32_t other) noexcept {
  const std::uint32_t v = add(slot, {vertices_[other].carriers, carrier_counts_[other]}, rest_positions_[other]);
  positions_[v] = positions_[other];
  vertices_[v].freed = vertices_[other].freed;
  offsets_[v] = offsets_[other];
  if (freed_.contains(other)) freed_.insert(v);
  return v;
}

// The new ones are used before the old ones are dropped, so no rotation is forgotten in between.
void VertexList::set_carriers(std::uint32_t vertex, const Carriers& carriers) noexcept {
  for (std::size_t k = 0; k < carriers.count; ++k) rotations_.use(carriers.nodes[k]);
  for (std::size_t k = 0; k < carrier_counts_[vertex]; ++k) rotations_.drop(vertices_[vertex].carriers[k]);
  vertices_[vertex].carriers = carriers.nodes;
  carrier_counts_[vertex] = static_cast<std::uint8_t>(carriers.count);
  freed_.insert(vertex);
}

void VertexList::forget(std::size_t vertex) noexcept {
  const std::uint32_t slot = vertices_[vertex].slot;
  slot_vertices_[slot] = kNone;
  if (is_node(slot)) return;
  for (std::size_t k = 0; k < carrier_counts_[vertex]; ++k) rotations_.drop(vertices_[vertex].carriers[k]);
}

Vec3 VertexList::own_place(std::size_t vertex, VecView positions) const noexcept {
  const auto& nodes = vertices_[vertex].carriers;
  const std::size_t count = carrier_counts_[vertex];
  if (is_node(vertices_[vertex].slot)) return positions[nodes[0]];
  Vec3 sum = Vec3::Zero();
  for (std::size_t k = 0; k < count; ++k) {
    const Vec3 arm = rest_positions_[vertex] - mesh_.positions[nodes[k]];
    sum += positions[nodes[k]] + rotations_[nodes[k]] * arm;
  }
  return kShares[count] * sum;
}

void VertexList::place(VecView positions, double time) noexcept {
  for (std::size_t v = 0; v < count_; ++v) {
    positions_[v] = own_place(v, positions);
    const double age = time - vertices_[v].freed;
    if (age < settle_) positions_[v] += (1 - age / settle_) * offsets_[v];
  }
}

void VertexList::settle(VecView positions, double time) noexcept {
  for (const std::uint32_t v : freed_.items()) {
    const Vec3 place = own_place(v, positions);
    const Vec3 offset = positions_[v] - place;
    const bool stays = settle_ > 0 && is_finite(offset);
    vertices_[v].freed = stays ? time : kLongAgo;
    offsets_[v] = offset;
    if (!stays) positions_[v] = place;
  }
  freed_.clear();
}

}  // namespace crumble
