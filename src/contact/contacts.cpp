#include "crumble/contact/contacts.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "crumble/base/error.hpp"

namespace crumble {
namespace {

struct Box {
  Vec3 low, high;
  bool contains(const Vec3& p) const { return (p.array() >= low.array()).all() && (p.array() <= high.array()).all(); }
};

Box box_of(const ConvexPolyhedron& shape, const Frame& frame) {
  Box box{Vec3::Constant(std::numeric_limits<double>::infinity()),
          Vec3::Constant(-std::numeric_limits<double>::infinity())};
  for (const Vec3& vertex : shape.vertices) {
    const Vec3 p = frame.to_scene(vertex);
    box.low = box.low.cwiseMin(p), box.high = box.high.cwiseMax(p);
  }
  return box;
}

double greatest_travel(const ConvexPolyhedron& shape, const Frame& from, const Frame& to) {
  double greatest = 0;
  for (const Vec3& v : shape.vertices) greatest = std::max(greatest, squared_norm(to.to_scene(v) - from.to_scene(v)));
  return std::sqrt(greatest);
}

// The paper's rule: from an inside point along `direction` to the first face on the way out.
bool leave_along(const ConvexPolyhedron& shape, const Vec3& p, const Vec3& direction, Vec3& out, std::uint32_t& face) {
  double least = std::numeric_limits<double>::infinity();
  for (std::uint32_t f = 0; f < shape.planes.size(); ++f) {
    const double approach = dot(shape.planes[f].normal, direction);
    if (approach <= 0) continue;
    const double way = (shape.planes[f].offset - dot(shape.planes[f].normal, p)) / approach;
    if (way < least) least = way, face = f;
  }
  if (!std::isfinite(least)) return false;
  out = p + least * direction;
  return true;
}

}  // namespace

Contacts::Contacts(std::vector<Tool> tools, std::vector<Wall> walls, std::span<const std::uint8_t> fixed,
                   ContactRule rule)
    : tools_(std::move(tools)),
      walls_(std::move(walls)),
      motions_(tools_.size()),
      fixed_(fixed.begin(), fixed.end()),
      rule_(rule) {
  for (const Tool& tool : tools_) {
    if (tool.shape.planes.size() < 4) throw Error(Code::empty, "tool.shape has no faces");
    check(tool.friction);
  }
  for (const Wall& wall : walls_) check(wall);
  // at most one contact per node: nothing grows later
  constraints_.reserve(fixed_.size()), previous_.reserve(fixed_.size());
  places_.reserve(fixed_.size()), previous_places_.reserve(fixed_.size());
  taken_.assign(fixed_.size(), 0);
}

void Contacts::move_tool(std::size_t tool, const Pose& target, double tau) noexcept {
  Motion& m = motions_[tool];
  const ConvexPolyhedron& shape = tools_[tool].shape;
  m.from = m.placed ? m.to : target;
  m.to = target;
  m.tau = tau;
  m.placed = true;
  m.travel = greatest_travel(shape, Frame(m.from), Frame(m.to));
  const double places = std::ceil(m.travel / shape.half_thickness);
  m.jumped = places > kMaxPlaces;
  if (m.jumped) {
    m.from = m.to, m.travel = 0, m.engaged = false;
    for (NodeConstraint& c : constraints_) {
      if (c.holder == tool) c.state = ContactState::released;
    }
  }
  m.places = m.jumped ? 1 : static_cast<std::uint32_t>(std::max(places, 1.0));
}

std::uint32_t Contacts::place_count() const noexcept {
  std::uint32_t most = 1;
  for (const Motion& m : motions_) most = std::max(most, m.places);
  return most;
}

void Contacts::find(std::uint32_t place, VecView positions) noexcept {
  std::swap(constraints_, previous_);
  std::swap(places_, previous_places_);
  constraints_.clear();
  places_.clear();
  std::fill(taken_.begin(), taken_.end(), 0);
  for (std::uint32_t t = 0; t < tools_.size(); ++t) find_of_tool(t, std::min(place, motions_[t].places - 1), positions);
  find_of_walls(positions);
}

// Where a node at `local` is put on the tool; false when the tool does not hold it. Outside the tool only a node that
// it held before stays, within `keep_gap`.
bool Contacts::place_on_tool(const Tool& tool, const Motion& motion, const Frame& frame, double keep_gap,
                             const Vec3& local, Place& place) const noexcept {
  const SurfaceQuery nearest = nearest_surface(tool.shape, local);
  if (nearest.signed_distance > keep_gap) return false;
  place = {nearest.point, nearest.plane};
  if (rule_ == ContactRule::along_motion && nearest.signed_distance < 0) {
    const Vec3 motion_here = frame.to_scene(local) - Frame(motion.from).to_scene(local);
    const double distance = norm(motion_here);
    if (distance > 1e-12)
      leave_along(tool.shape, local, rotate_back(frame.rotation, motion_here / distance), place.anchor, place.face);
  }
  return true;
}

void Contacts::find_of_tool(std::uint32_t t, std::uint32_t place_index, VecView positions) noexcept {
  const Tool& tool = tools_[t];
  Motion& motion = motions_[t];
  if (!motion.placed) return;
  const double progress = static_cast<double>(place_index + 1) / motion.places;
  const Frame frame(place_index + 1 == motion.places ? motion.to : interpolate(motion.from, motion.to, progress));
  const Box box = box_of(tool.shape, frame);

  if (!motion.engaged) {  // wait until no node is inside
    std::uint32_t face = 0;
    for (std::size_t i = 0; i < positions.size(); ++i) {
      const Vec3 p = positions[i];
      if (!fixed_[i] && box.contains(p) && greatest_plane_distance(tool.shape, frame.to_local(p), face) < -kTouch)
        return;
    }
    motion.engaged = true;
  }

  // a paper-rule contact holds what is inside only; the other follows the surface
  const double keep_gap = rule_ == ContactRule::along_motion ? 1e-9 : motion.travel + kKeepGap;
  const auto hold = [&](std::uint32_t node, ContactState state, const Place& place) {
    add(node, t, state, place, frame, rotate(frame.rotation, tool.shape.planes[place.face].normal), tool.friction);
    NodeConstraint& c = constraints_.back();
    c.velocity = (Frame(motion.to).to_scene(place.anchor) - Frame(motion.from).to_scene(place.anchor)) / motion.tau;
  };
  for (std::size_t k = 0; k < previous_.size(); ++k) {
    const NodeConstraint& before = previous_[k];
    if (before.holder != t || taken_[before.node] || before.state == ContactState::released) continue;
    Place place = previous_places_[k];
    const bool sticks = before.state == ContactState::stick;
    if (sticks || place_on_tool(tool, motion, frame, keep_gap, frame.to_local(positions[before.node]), place)) {
      hold(before.node, before.state, place);
    }
  }
  for (std::uint32_t i = 0; i < positions.size(); ++i) {
    const Vec3 p = positions[i];
    if (fixed_[i] || taken_[i] || !box.contains(p)) continue;
    Place place;
    if (std::uint32_t face = 0; greatest_plane_distance(tool.shape, frame.to_local(p), face) >= 0) continue;
    if (place_on_tool(tool, motion, frame, 0, frame.to_local(p), place)) hold(i, ContactState::fresh, place);
  }
}

void Contacts::find_of_walls(VecView positions) noexcept {
  static const Frame kScene{Pose{}};
  const auto hold = [&](std::uint32_t node, std::uint32_t w, ContactState state, const Vec3& anchor) {
    add(node, kWorldHolder, state, {anchor, w}, kScene, walls_[w].plane.normal, walls_[w].friction);
  };
  const auto height = [&](std::uint32_t node, std::uint32_t w) {
    return dot(walls_[w].plane.normal, positions[node]) - walls_[w].plane.offset;
  };
  for (std::size_t k = 0; k < previous_.size(); ++k) {
    const NodeConstraint& before = previous_[k];
    if (before.holder != kWorldHolder || taken_[before.node] || before.state == ContactState::released) continue;
    const std::uint32_t w = previous_places_[k].face;
    const double above = height(before.node, w);
    if (above > kKeepGap) continue;
    const bool sticks = before.state == ContactState::stick;
    hold(before.node, w, before.state,
         sticks ? previous_places_[k].anchor : Vec3(positions[before.node] - above * walls_[w].plane.normal));
  }
  for (std::uint32_t w = 0; w < walls_.size(); ++w) {
    for (std::uint32_t i = 0; i < positions.size(); ++i) {
      if (fixed_[i] || taken_[i]) continue;
      const double above = height(i, w);
      if (above < 0) hold(i, w, ContactState::fresh, positions[i] - above * walls_[w].plane.normal);
    }
  }
}

void Contacts::add(std::uint32_t node, std::uint32_t holder, ContactState state, const Place& place, const Frame& frame,
                   const Vec3& normal, const Friction& friction) noexcept {
  NodeConstraint c;
  c.node = node;
  c.holder = holder;
  c.state = state;
  c.point = frame.to_scene(place.anchor);
  c.normal = normal;
  c.static_friction = friction.static_coefficient;
  c.dynamic_friction = friction.dynamic_coefficient;
  constraints_.push_back(c);
  places_.push_back(place);
  taken_[node] = 1;
}

void Contacts::project(VecSpan positions, VecSpan velocities) noexcept {
  for (const NodeConstraint& c : constraints_) {
    positions.set(c.node, c.point);
    const Vec3 lag = c.velocity - velocities[c.node];
    velocities.set(c.node,
                   velocities[c.node] + (c.state == ContactState::stick ? lag : Vec3(dot(lag, c.normal) * c.normal)));
  }
}

void Contacts::drop_released() noexcept {
  std::size_t kept = 0;
  for (std::size_t k = 0; k < constraints_.size(); ++k) {
    if (constraints_[k].state == ContactState::released) continue;
    places_[kept] = places_[k];
    constraints_[kept++] = constraints_[k];
  }
  constraints_.resize(kept);
  places_.resize(kept);
}

void Contacts::clear() noexcept {
  constraints_.clear();
  places_.clear();
  motions_.assign(motions_.size(), Motion{});
}

}  // namespace crumble
