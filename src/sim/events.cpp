// What the log of events is told.
#include "crumble/sim/simulation.hpp"

namespace crumble {

void Simulation::log_cut(std::uint32_t spring) noexcept {
  const auto [a, b] = network_.springs[spring];
  const Vec3 p = solver_->position(a), q = solver_->position(b);
  const double excess = norm(q - p) - network_.rest_lengths[spring];
  Event event;
  event.kind = EventKind::cut;
  event.spring = spring;
  event.fragment = fragments_.labels()[a];
  event.place = 0.5 * (p + q);
  event.energy = 0.5 * network_.stiffnesses[spring] * excess * excess;
  event_log_.add(event);
}

void Simulation::log_contacts() noexcept {
  event_log_.add_contacts(contacts_.constraints(), [&](Event& event, const NodeConstraint* beginning) {
    event.fragment = fragments_.labels()[event.node];
    event.place = beginning ? beginning->point : solver_->position(event.node);
    if (beginning) event.energy = 0.5 * network_.masses[event.node] * beginning->approach * beginning->approach;
  });
}

}  // namespace crumble
