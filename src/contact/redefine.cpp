// Other tools, walls and fixed nodes for a body in mid-run.
#include "crumble/contact/contacts.hpp"

namespace crumble {

void Contacts::redefine(Contacts& next, std::span<const std::uint8_t> moved_tools, bool moved_walls) noexcept {
  tools_.swap(next.tools_);
  walls_.swap(next.walls_);
  bounds_.swap(next.bounds_);
  rule_ = next.rule_;
  if (surface_.face_count() != next.surface_.face_count()) std::swap(surface_, next.surface_);
  for (std::size_t tool = 0; tool < tools_.size(); ++tool) {
    if (!moved_tools[tool]) continue;
    const bool suspended = motions_[tool].suspended;
    motions_[tool] = Motion{};
    motions_[tool].suspended = suspended;
  }
  for (NodeConstraint& c : constraints_) {
    const bool on_wall = c.holder == kWorldHolder, on_tool = c.holder < tools_.size();
    const bool gone = (on_wall && moved_walls) || (on_tool && moved_tools[c.holder]);
    if (gone || next.uses_[c.node] == Use::fixed) c.state = ContactState::released;
  }
  drop_released();
  for (std::size_t node = 0; node < uses_.size(); ++node) {
    const bool is_fixed = next.uses_[node] == Use::fixed;
    if (is_fixed || uses_[node] == Use::fixed) uses_[node] = is_fixed ? Use::fixed : Use::free;
  }
  for (std::size_t k = 0; k < constraints_.size(); ++k) take_friction(constraints_[k], places_[k]);
}

// An attached node has none: it is never released.
void Contacts::take_friction(NodeConstraint& c, const Place& place) const noexcept {
  if (c.state == ContactState::attached) return;
  const Friction& friction = c.holder == kWorldHolder ? walls_[place.wall].friction : tools_[c.holder].friction;
  c.static_friction = friction.static_coefficient, c.dynamic_friction = friction.dynamic_coefficient;
}

}  // namespace crumble
