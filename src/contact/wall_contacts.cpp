#include <algorithm>

#include "crumble/contact/contacts.hpp"

// Walls hold what no tool holds.

namespace crumble {

// A node has one wall at a time: the one that it lies deepest behind, so that what slides along one is stopped by the
// next. It is put before all of them.
void Contacts::find_of_walls(NodeSource& nodes) noexcept {
  const auto above = [&](const Vec3& p, std::uint32_t w) {
    return dot(walls_[w].plane.normal, p) - walls_[w].plane.offset;
  };
  const auto is_deepest = [&](const Vec3& p, std::uint32_t w) {
    for (std::uint32_t v = 0; v < walls_.size(); ++v) {
      if (v != w && above(p, v) < std::min(above(p, w), 0.0)) return false;
    }
    return true;
  };
  const auto on_wall = [&](const Vec3& p, std::uint32_t w) {
    Place place{.anchor = p - above(p, w) * walls_[w].plane.normal, .normal = walls_[w].plane.normal, .wall = w};
    for (std::uint32_t v = 0; v < walls_.size(); ++v) {
      if (v != w && above(place.anchor, v) < 0) place.anchor -= above(place.anchor, v) * walls_[v].plane.normal;
    }
    return place;
  };
  for (std::size_t k = 0; k < previous_.size(); ++k) {
    const NodeConstraint& before = previous_[k];
    if (before.holder != kWorldHolder || before.state == ContactState::released) continue;
    if (uses_[before.node] != Use::free) continue;
    const std::uint32_t w = previous_places_[k].wall;
    const Vec3 p = nodes.position(before.node);
    if (above(p, w) > kKeepGap || !is_deepest(p, w)) continue;
    hold_by_wall(before.node, &before, before.state == ContactState::stick ? previous_places_[k] : on_wall(p, w));
  }
  for (std::uint32_t w = 0; w < walls_.size(); ++w) {
    for (const std::uint32_t i : nodes.behind(walls_[w].plane)) {
      if (uses_[i] != Use::free) continue;
      const Vec3 p = nodes.position(i);
      if (above(p, w) < 0 && is_deepest(p, w)) hold_by_wall(i, nullptr, on_wall(p, w));
    }
  }
}

void Contacts::hold_by_wall(std::uint32_t node, const NodeConstraint* before, const Place& place) noexcept {
  NodeConstraint c;
  c.node = node;
  c.holder = kWorldHolder;
  if (before) c.state = before->state, c.approach = before->approach;
  c.point = place.anchor;
  c.normal = place.normal;
  c.static_friction = walls_[place.wall].friction.static_coefficient;
  c.dynamic_friction = walls_[place.wall].friction.dynamic_coefficient;
  add(c, place);
}

}  // namespace crumble
