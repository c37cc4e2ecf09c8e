#include "crumble/contact/contacts.hpp"

#include <algorithm>

#include "contact/tool_bounds.hpp"
#include "crumble/base/error.hpp"
#include "crumble/base/memory.hpp"

namespace crumble {
namespace {

void check(const Attachment& attachment, std::size_t index, std::span<const std::uint8_t> fixed) {
  const std::string name = "attachments[" + std::to_string(index) + "].nodes";
  if (attachment.nodes.empty()) throw Error(Code::empty, name + " is empty");
  for (const std::uint32_t node : attachment.nodes) {
    if (node >= fixed.size()) {
      throw Error(Code::out_of_range,
                  name + " names node " + std::to_string(node) + " of " + std::to_string(fixed.size()));
    }
    if (fixed[node]) throw Error(Code::state, name + " names node " + std::to_string(node) + ", which is fixed");
  }
}

}  // namespace

Contacts::Contacts(Vector<Tool> tools, Vector<Wall> walls, std::span<const std::uint8_t> fixed, ContactRule rule,
                   Vector<Attachment> attachments, SurfaceSamples surface)
    : tools_(std::move(tools)),
      walls_(std::move(walls)),
      attachments_(std::move(attachments)),
      motions_(tools_.size() + attachments_.size()),
      rule_(rule),
      surface_(std::move(surface)) {
  for (const Tool& tool : tools_) {
    check(tool);
    const Box box = box_of(*tool.shape, Frame(Pose{}));
    bounds_.push_back({box.low, box.high});
  }
  for (const Wall& wall : walls_) check(wall);
  // at most one contact per node: nothing grows later
  constraints_.reserve(fixed.size()), previous_.reserve(fixed.size());
  places_.reserve(fixed.size()), previous_places_.reserve(fixed.size());
  roused_.reserve(fixed.size());
  hints_.assign(fixed.size(), 0);
  held_at_.assign(fixed.size(), 0);
  for (const std::uint8_t is_fixed : fixed) uses_.push_back(is_fixed ? Use::fixed : Use::free);
  for (std::size_t a = 0; a < attachments_.size(); ++a) {
    check(attachments_[a], a, fixed);
    for (const std::uint32_t node : attachments_[a].nodes) {
      if (uses_[node] == Use::attached) {
        throw Error(Code::state, "attachments[" + std::to_string(a) + "].nodes names node " + std::to_string(node) +
                                     ", which is attached already");
      }
      uses_[node] = Use::attached;
      anchors_.push_back(Vec3::Zero());
    }
  }
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
  for (const NodeConstraint& c : previous_) {
    if (uses_[c.node] == Use::held) uses_[c.node] = Use::free;
  }
  for (std::uint32_t t = 0; t < tools_.size(); ++t) find_of_tool(t, std::min(place, motions_[t].places - 1), nodes);
  for (std::size_t a = 0; a < attachments_.size(); ++a) find_attached(a, nodes);
  find_of_walls(nodes);
}

void Contacts::project(NodeSource& nodes) noexcept {
  for (NodeConstraint& c : constraints_) project(c, nodes);
}

void Contacts::project(NodeConstraint& c, NodeSource& nodes) noexcept {
  if (c.state == ContactState::stick || c.state == ContactState::attached) {
    nodes.place(c.node, c.point, c.velocity);
    return;
  }
  const Vec3 velocity = nodes.velocity(c.node);
  const double approach = dot(c.velocity - velocity, c.normal);
  if (c.state == ContactState::fresh) c.approach = std::max(c.approach, approach);
  nodes.place(c.node, c.point, velocity + approach * c.normal);
}

NodeConstraint Contacts::on_tool(std::uint32_t t, const Frame& frame, std::uint32_t node, ContactState state,
                                 const Place& place) const noexcept {
  NodeConstraint c;
  c.node = node;
  c.holder = t;
  c.state = state;
  c.point = frame.to_scene(place.anchor);
  c.normal = rotate(frame.rotation, place.normal);
  c.velocity = motions_[t].velocity + rotate(motions_[t].turning, place.anchor);
  c.static_friction = tools_[t].friction.static_coefficient;
  c.dynamic_friction = tools_[t].friction.dynamic_coefficient;
  return c;
}

void Contacts::add(const NodeConstraint& c, const Place& place) noexcept {
  held_at_[c.node] = static_cast<std::uint32_t>(constraints_.size());
  constraints_.push_back(c);
  places_.push_back(place);
  if (c.state != ContactState::attached) uses_[c.node] = Use::held;
}

void Contacts::drop_released() noexcept {
  std::size_t kept = 0;
  for (std::size_t k = 0; k < constraints_.size(); ++k) {
    const std::uint32_t node = constraints_[k].node;
    if (constraints_[k].state == ContactState::released) {
      if (uses_[node] == Use::held) uses_[node] = Use::free;
      continue;
    }
    held_at_[node] = static_cast<std::uint32_t>(kept);
    places_[kept] = places_[k];
    constraints_[kept++] = constraints_[k];
  }
  constraints_.resize(kept);
  places_.resize(kept);
}

void Contacts::let_sleep(std::uint32_t node) noexcept {
  if (uses_[node] == Use::attached) return;
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
  if (uses_[node] != Use::held && uses_[node] != Use::attached) return;
  for (NodeConstraint& c : constraints_) {
    if (c.node == node) c.state = ContactState::released;
  }
  drop_released();
}

void Contacts::clear() noexcept {
  for (Use& use : uses_) use = use == Use::fixed ? Use::fixed : Use::free;
  for (const Attachment& attachment : attachments_) {
    for (const std::uint32_t node : attachment.nodes) uses_[node] = Use::attached;
  }
  constraints_.clear();
  places_.clear();
  motions_.assign(motions_.size(), Motion{});
  surface_.clear();
}

}  // namespace crumble
