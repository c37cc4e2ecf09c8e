#include "crumble/contact/contacts.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "contact/tool_bounds.hpp"
#include "crumble/base/error.hpp"

namespace crumble {
namespace {

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
    : tools_(std::move(tools)), walls_(std::move(walls)), motions_(tools_.size()), rule_(rule) {
  for (const Tool& tool : tools_) {
    if (tool.shape.planes.size() < 4) throw Error(Code::empty, "tool.shape has no faces");
    check(tool.friction);
    corners_.push_back(corners_of(tool.shape));
  }
  for (const Wall& wall : walls_) check(wall);
  // at most one contact per node: nothing grows later
  constraints_.reserve(fixed.size()), previous_.reserve(fixed.size());
  places_.reserve(fixed.size()), previous_places_.reserve(fixed.size());
  roused_.reserve(fixed.size());
  last_faces_.assign(fixed.size(), 0);
  for (const std::uint8_t is_fixed : fixed) uses_.push_back(is_fixed ? Use::fixed : Use::free);
}

void Contacts::move_tool(std::size_t tool, const Pose& target, double tau) noexcept {
  Motion& m = motions_[tool];
  const Frame target_frame(target);
  m.from = m.placed ? m.to : target;
  m.from_frame = m.placed ? m.to_frame : target_frame;
  m.to = target;
  m.to_frame = target_frame;
  m.placed = true;
  m.travel = greatest_travel(corners_[tool], m.from_frame, m.to_frame);
  const double places = std::ceil(m.travel / tools_[tool].shape.half_thickness);
  m.jumped = places > kMaxPlaces;
  if (m.jumped) {
    m.from = m.to, m.from_frame = m.to_frame, m.travel = 0, m.engaged = false;
    for (NodeConstraint& c : constraints_) {
      if (c.holder == tool) c.state = ContactState::released;
    }
  }
  m.velocity = (m.to_frame.origin - m.from_frame.origin) / tau;
  m.turning = (m.to_frame.rotation - m.from_frame.rotation) / tau;
  m.places = m.jumped ? 1 : static_cast<std::uint32_t>(std::max(places, 1.0));
}

std::uint32_t Contacts::place_count() const noexcept {
  std::uint32_t most = 1;
  for (const Motion& m : motions_) most = std::max(most, m.places);
  return most;
}

void Contacts::find(std::uint32_t place, NodeSource& nodes) noexcept {
  std::swap(constraints_, previous_);
  std::swap(places_, previous_places_);
  constraints_.clear();
  places_.clear();
  roused_.clear();
  for (const NodeConstraint& c : previous_) uses_[c.node] = Use::free;
  for (std::uint32_t t = 0; t < tools_.size(); ++t) find_of_tool(t, std::min(place, motions_[t].places - 1), nodes);
  find_of_walls(nodes);
}

void Contacts::find_of_tool(std::uint32_t t, std::uint32_t place_index, NodeSource& nodes) noexcept {
  const Tool& tool = tools_[t];
  Motion& motion = motions_[t];
  if (!motion.placed) return;
  const bool last = place_index + 1 == motion.places;
  const double progress = static_cast<double>(place_index + 1) / motion.places;
  const Frame frame = last ? motion.to_frame : Frame(interpolate(motion.from, motion.to, progress));
  const Box box = box_of(corners_[t], frame);
  const std::span<const std::uint32_t> near = nodes.inside(box.low, box.high);
  motion.engaged = motion.engaged || is_outside(tool, frame, near, nodes);
  if (!motion.engaged) return;
  keep_on_tool(t, frame, nodes);
  enter_tool(t, frame, near, nodes);
}

bool Contacts::is_outside(const Tool& tool, const Frame& frame, std::span<const std::uint32_t> near,
                          const NodeSource& nodes) const noexcept {
  return std::none_of(near.begin(), near.end(), [&](std::uint32_t i) {
    if (uses_[i] == Use::fixed || uses_[i] == Use::excluded) return false;
    std::uint32_t face = 0;
    return greatest_plane_distance(tool.shape, frame.to_local(nodes.position(i)), face) < -kTouch;
  });
}

// What the tool held before. One that sticks stays where it is on the tool; its position is not asked for.
void Contacts::keep_on_tool(std::uint32_t t, const Frame& frame, const NodeSource& nodes) noexcept {
  const Tool& tool = tools_[t];
  const Motion& motion = motions_[t];
  // a paper-rule contact holds what is inside only; the other follows the surface
  const double keep_gap = rule_ == ContactRule::along_motion ? 1e-9 : motion.travel + kKeepGap;
  for (std::size_t k = 0; k < previous_.size(); ++k) {
    const NodeConstraint& before = previous_[k];
    if (before.holder != t || before.state == ContactState::released || uses_[before.node] != Use::free) continue;
    Place place = previous_places_[k];
    if (before.state == ContactState::stick ||
        place_on_tool(tool, motion, frame, keep_gap, frame.to_local(nodes.position(before.node)), place)) {
      hold(t, frame, before.node, before.state, place).approach = before.approach;
    }
  }
}

// What came to lie inside it. Most of what is near is outside, and mostly above the face that it was above last time.
void Contacts::enter_tool(std::uint32_t t, const Frame& frame, std::span<const std::uint32_t> near,
                          const NodeSource& nodes) noexcept {
  const Tool& tool = tools_[t];
  const Motion& motion = motions_[t];
  const std::vector<Plane>& planes = tool.shape.planes;
  for (const std::uint32_t i : near) {
    if (uses_[i] != Use::free && uses_[i] != Use::asleep) continue;
    const Vec3 local = frame.to_local(nodes.position(i));
    std::uint32_t& face = last_faces_[i];
    const Plane& likely = planes[face < planes.size() ? face : 0];  // it may be another tool's
    if (dot(likely.normal, local) - likely.offset >= 0) continue;
    const double distance = greatest_plane_distance(tool.shape, local, face);
    if (!(distance < 0)) continue;  // nor what is not a number
    Place place{local - distance * planes[face].normal, face};
    if (rule_ == ContactRule::along_motion) leave_along_motion(tool, motion, frame, local, place);
    if (uses_[i] == Use::asleep) roused_.push_back(i);
    hold(t, frame, i, ContactState::fresh, place);
  }
}

// Where a node at `local` that the tool held before is put on it; false when it came to lie farther outside than
// `keep_gap`.
bool Contacts::place_on_tool(const Tool& tool, const Motion& motion, const Frame& frame, double keep_gap,
                             const Vec3& local, Place& place) const noexcept {
  const SurfaceQuery nearest = nearest_surface(tool.shape, local, keep_gap);
  if (nearest.signed_distance > keep_gap) return false;
  place = {nearest.point, nearest.plane};
  if (rule_ == ContactRule::along_motion && nearest.signed_distance < 0) {
    leave_along_motion(tool, motion, frame, local, place);
  }
  return true;
}

void Contacts::leave_along_motion(const Tool& tool, const Motion& motion, const Frame& frame, const Vec3& local,
                                  Place& place) const noexcept {
  const Vec3 motion_here = frame.to_scene(local) - motion.from_frame.to_scene(local);
  const double distance = norm(motion_here);
  if (distance > 1e-12)
    leave_along(tool.shape, local, rotate_back(frame.rotation, motion_here / distance), place.anchor, place.face);
}

NodeConstraint& Contacts::hold(std::uint32_t t, const Frame& frame, std::uint32_t node, ContactState state,
                               const Place& place) noexcept {
  const Tool& tool = tools_[t];
  NodeConstraint c;
  c.holder = t;
  c.point = frame.to_scene(place.anchor);
  c.normal = rotate(frame.rotation, tool.shape.planes[place.face].normal);
  c.velocity = motions_[t].velocity + rotate(motions_[t].turning, place.anchor);
  return add(c, node, state, place, tool.friction);
}

void Contacts::find_of_walls(NodeSource& nodes) noexcept {
  const auto height = [&](const Vec3& p, std::uint32_t w) {
    return dot(walls_[w].plane.normal, p) - walls_[w].plane.offset;
  };
  for (std::size_t k = 0; k < previous_.size(); ++k) {
    const NodeConstraint& before = previous_[k];
    if (before.holder != kWorldHolder || before.state == ContactState::released) continue;
    if (uses_[before.node] != Use::free) continue;
    const std::uint32_t w = previous_places_[k].face;
    const Vec3 p = nodes.position(before.node);
    const double above = height(p, w);
    if (above > kKeepGap) continue;
    const bool sticks = before.state == ContactState::stick;
    hold_by_wall(before.node, before.state,
                 {sticks ? previous_places_[k].anchor : Vec3(p - above * walls_[w].plane.normal), w})
        .approach = before.approach;
  }
  for (std::uint32_t w = 0; w < walls_.size(); ++w) {
    for (const std::uint32_t i : nodes.behind(walls_[w].plane)) {
      if (uses_[i] != Use::free) continue;
      const Vec3 p = nodes.position(i);
      const double above = height(p, w);
      if (above < 0) hold_by_wall(i, ContactState::fresh, {p - above * walls_[w].plane.normal, w});
    }
  }
}

NodeConstraint& Contacts::hold_by_wall(std::uint32_t node, ContactState state, const Place& place) noexcept {
  const Wall& wall = walls_[place.face];
  NodeConstraint c;
  c.holder = kWorldHolder;
  c.point = place.anchor;
  c.normal = wall.plane.normal;
  return add(c, node, state, place, wall.friction);
}

NodeConstraint& Contacts::add(NodeConstraint& c, std::uint32_t node, ContactState state, const Place& place,
                              const Friction& friction) noexcept {
  c.node = node;
  c.state = state;
  c.static_friction = friction.static_coefficient;
  c.dynamic_friction = friction.dynamic_coefficient;
  constraints_.push_back(c);
  places_.push_back(place);
  uses_[node] = Use::held;
  return constraints_.back();
}

void Contacts::project(NodeSource& nodes) noexcept {
  for (NodeConstraint& c : constraints_) {
    if (c.state == ContactState::stick) {
      nodes.place(c.node, c.point, c.velocity);
    } else {
      const Vec3 velocity = nodes.velocity(c.node);
      const double approach = dot(c.velocity - velocity, c.normal);
      if (c.state == ContactState::fresh) c.approach = std::max(c.approach, approach);
      nodes.place(c.node, c.point, velocity + approach * c.normal);
    }
  }
}

void Contacts::drop_released() noexcept {
  std::size_t kept = 0;
  for (std::size_t k = 0; k < constraints_.size(); ++k) {
    if (constraints_[k].state == ContactState::released) {
      uses_[constraints_[k].node] = Use::free;
      continue;
    }
    places_[kept] = places_[k];
    constraints_[kept++] = constraints_[k];
  }
  constraints_.resize(kept);
  places_.resize(kept);
}

void Contacts::let_sleep(std::uint32_t node) noexcept {
  release(node);
  uses_[node] = Use::asleep;
}

void Contacts::wake(std::uint32_t node) noexcept {
  if (uses_[node] == Use::asleep) uses_[node] = Use::free;
}

void Contacts::exclude(std::uint32_t node) noexcept {
  release(node);
  uses_[node] = Use::excluded;
}

void Contacts::release(std::uint32_t node) noexcept {
  if (uses_[node] != Use::held) return;
  for (NodeConstraint& c : constraints_) {
    if (c.node == node) c.state = ContactState::released;
  }
  drop_released();
}

void Contacts::clear() noexcept {
  for (Use& use : uses_) use = use == Use::fixed ? Use::fixed : Use::free;
  constraints_.clear();
  places_.clear();
  motions_.assign(motions_.size(), Motion{});
}

}  // namespace crumble
