#include <algorithm>
#include <cmath>

#include "contact/tool_bounds.hpp"
#include "crumble/contact/contacts.hpp"

// Tools against nodes: how a tool moves, what it keeps, what enters it, and what is put out of it after the solver.

namespace crumble {
namespace {

constexpr double kRounding = 1e-12;  // metres; a node on the surface may seem to be inside by this
constexpr int kPushOutRounds = 4;    // a node put out of one tool may come to lie in another; tools overlap if always

}  // namespace

Frame Contacts::frame_of(std::size_t holder, const Pose& hand) const noexcept {
  return Frame(holder < tools_.size() ? compose(hand, tools_[holder].offset) : hand);
}

void Contacts::move_holder(std::size_t holder, const Pose& target, double tau) noexcept {
  Motion& m = motions_[holder];
  const Frame target_frame = frame_of(holder, target);
  m.from = m.placed ? m.to : target;
  m.from_frame = m.placed ? m.to_frame : target_frame;
  m.to = target;
  m.to_frame = target_frame;
  m.tau = tau;
  m.placed = true;
  if (holder < tools_.size()) {
    move_tool(holder);
  } else {
    move_attachment(holder);
  }
  m.velocity = (m.to_frame.origin - m.from_frame.origin) / tau;
  m.turning = (m.to_frame.rotation - m.from_frame.rotation) / tau;
}

void Contacts::move_tool(std::size_t tool) noexcept {
  Motion& m = motions_[tool];
  m.travel = greatest_travel(*tools_[tool].shape, m.from_frame, m.to_frame);
  const SolidModel& shape = *tools_[tool].shape;
  m.jumped = m.travel > kMaxPlaces * shape.half_thickness();
  const double places = std::clamp(std::ceil(m.travel / thickness_met(shape)), 1.0, double{kMaxPlaces});
  m.places = m.jumped ? 1 : static_cast<std::uint32_t>(places);
  if (!m.jumped) return;
  m.from = m.to, m.from_frame = m.to_frame, m.travel = 0;
  let_go(tool);
}

void Contacts::suspend(std::size_t tool, bool suspended) noexcept {
  if (tool >= tools_.size() || motions_[tool].suspended == suspended) return;
  motions_[tool].suspended = suspended;
  if (!suspended) return;
  let_go(tool);
  drop_released();
}

void Contacts::let_go(std::size_t tool) noexcept {
  motions_[tool].engaged = false;
  for (NodeConstraint& c : constraints_) {
    if (c.holder == tool) c.state = ContactState::released;
  }
}

void Contacts::find_of_tool(std::uint32_t t, std::uint32_t place_index, NodeSource& nodes) noexcept {
  const Tool& tool = tools_[t];
  Motion& motion = motions_[t];
  if (!motion.placed || motion.suspended) return;
  const bool last = place_index + 1 == motion.places;
  const double progress = static_cast<double>(place_index + 1) / motion.places;
  const Frame frame = last ? motion.to_frame : frame_of(t, interpolate(motion.from, motion.to, progress));
  const Box box = box_of(*tool.shape, frame);
  const std::span<const std::uint32_t> near = nodes.inside(box.low, box.high);
  motion.engaged = motion.engaged || is_outside(tool, frame, near, nodes);
  if (!motion.engaged) return;
  keep_on_tool(t, frame, nodes);
  enter_tool(t, frame, near, nodes);
  if (is_thin(tool)) meet_faces(t, frame, nodes);
}

bool Contacts::is_outside(const Tool& tool, const Frame& frame, std::span<const std::uint32_t> near,
                          const NodeSource& nodes) const noexcept {
  return std::none_of(near.begin(), near.end(), [&](std::uint32_t i) {
    if (uses_[i] == Use::fixed || uses_[i] == Use::excluded || uses_[i] == Use::attached) return false;
    std::uint32_t hint = 0;
    SolidPoint nearest;
    return tool.shape->find_inside(frame.to_local(nodes.position(i)), hint, nearest) &&
           nearest.signed_distance < -kTouch;
  });
}

// What the tool held before. One that sticks stays where it is on the tool; its position is not asked for.
void Contacts::keep_on_tool(std::uint32_t t, const Frame& frame, const NodeSource& nodes) noexcept {
  const Tool& tool = tools_[t];
  const Motion& motion = motions_[t];
  // a paper-rule contact holds what is inside only; the other follows the surface
  const double keep_gap = rule_ == ContactRule::along_motion ? 1e-9 : motion.travel + kKeepGap;
  std::uint32_t face = kNoFace;  // the corners of one stand one behind the other
  bool near = false;
  for (std::size_t k = 0; k < previous_.size(); ++k) {
    const NodeConstraint& before = previous_[k];
    if (before.holder != t || before.state == ContactState::released || uses_[before.node] != Use::free) continue;
    const bool sticks = before.state == ContactState::stick;
    Place place = previous_places_[k];
    const auto local = [&] { return frame.to_local(nodes.position(before.node)); };
    if (place.face != kNoFace) {
      if (!sticks) keep_height(local(), place);
      if (place.face != face) face = place.face, near = is_near(face, t, frame, keep_gap, nodes);
      if (!near) let_back(motion, place);
      stay_outside(tool, place);
    } else if (!sticks && !place_on_tool(tool, motion, frame, keep_gap, local(), place)) {
      continue;
    }
    NodeConstraint c = on_tool(t, frame, before.node, before.state, place);
    c.approach = before.approach;
    add(c, place);
  }
}

// What came to lie inside it.
void Contacts::enter_tool(std::uint32_t t, const Frame& frame, std::span<const std::uint32_t> near,
                          const NodeSource& nodes) noexcept {
  const Tool& tool = tools_[t];
  const Motion& motion = motions_[t];
  for (const std::uint32_t i : near) {
    if (uses_[i] != Use::free && uses_[i] != Use::asleep) continue;
    const Vec3 local = frame.to_local(nodes.position(i));
    SolidPoint nearest;
    if (!tool.shape->find_inside(local, hints_[i], nearest)) continue;
    Place place{.anchor = nearest.point, .normal = nearest.normal};
    if (rule_ == ContactRule::along_motion) leave_along_motion(tool, motion, frame, local, place);
    if (uses_[i] == Use::asleep) roused_.push_back(i);
    add(on_tool(t, frame, i, ContactState::fresh, place), place);
  }
}

// Where a node at `local` that the tool held before is put on it; false when it came to lie farther outside than
// `keep_gap`.
bool Contacts::place_on_tool(const Tool& tool, const Motion& motion, const Frame& frame, double keep_gap,
                             const Vec3& local, Place& place) const noexcept {
  const SolidPoint nearest = tool.shape->nearest(local, keep_gap);
  if (nearest.signed_distance > keep_gap) return false;
  place = {.anchor = nearest.point, .normal = nearest.normal};
  if (rule_ == ContactRule::along_motion && nearest.signed_distance < 0) {
    leave_along_motion(tool, motion, frame, local, place);
  }
  return true;
}

void Contacts::leave_along_motion(const Tool& tool, const Motion& motion, const Frame& frame, const Vec3& local,
                                  Place& place) const noexcept {
  const Vec3 motion_here = frame.to_scene(local) - motion.from_frame.to_scene(local);
  const double distance = norm(motion_here);
  if (distance <= 1e-12) return;
  SolidPoint out;
  if (tool.shape->leave_along(local, rotate_back(frame.rotation, motion_here / distance), out)) {
    place = {.anchor = out.point, .normal = out.normal};
  }
}

void Contacts::push_out(NodeSource& nodes) noexcept {
  if (rule_ == ContactRule::along_motion) return;
  const int rounds = tools_.size() > 1 ? kPushOutRounds : 1;  // a tool may put a node into another
  bool moved = true;
  for (int round = 0; round < rounds && moved; ++round) {
    moved = false;
    for (std::uint32_t t = 0; t < tools_.size(); ++t) moved |= push_out_of(t, nodes);
  }
}

// What sticks to a tool's surface is not inside it, and not inside another unless the tools overlap. A sleeping node
// did not move.
bool Contacts::push_out_of(std::uint32_t t, NodeSource& nodes) noexcept {
  const Motion& motion = motions_[t];
  if (!motion.engaged) return false;
  const Frame& frame = motion.to_frame;
  const Box box = box_of(*tools_[t].shape, frame);
  bool moved = false;
  for (const std::uint32_t i : nodes.inside(box.low, box.high)) {
    if (uses_[i] != Use::free && uses_[i] != Use::held) continue;
    const std::uint32_t at = held_at_[i];
    const bool held = uses_[i] == Use::held;
    if (held && constraints_[at].state == ContactState::stick && places_[at].face == kNoFace) continue;
    SolidPoint nearest;
    if (!tools_[t].shape->find_inside(frame.to_local(nodes.position(i)), hints_[i], nearest)) continue;
    if (nearest.signed_distance > -kRounding) continue;
    const Place place{.anchor = nearest.point, .normal = nearest.normal};
    NodeConstraint c = on_tool(t, frame, i, ContactState::fresh, place);
    project(c, nodes);
    moved = true;
    if (held) {
      put_held(at, c, place);
    } else {
      add(c, place);
    }
  }
  return moved;
}

// A held node was put to where `c` and `place` say. Another tool or wall that holds it keeps it, at its new place: who
// has it is for the next find() to say, and this step's force is that of the one that had it.
void Contacts::put_held(std::uint32_t at, const NodeConstraint& c, const Place& place) noexcept {
  NodeConstraint& held = constraints_[at];
  if (held.state == ContactState::released) {
    held = c, places_[at] = place;
  } else if (held.holder == c.holder) {
    const NodeConstraint before = held;
    held = c, places_[at] = place;
    held.state = before.state, held.approach = before.approach, held.reaction = before.reaction;
  } else {
    held.point = c.point;
    places_[at].anchor = held.holder == kWorldHolder ? c.point : frame(held.holder).to_local(c.point);
  }
}

}  // namespace crumble
