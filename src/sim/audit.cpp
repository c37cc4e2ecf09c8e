// The energy ledger: what each stage did to springs + kinetic energy. Only when StepSettings::energy_audit asks for it.
#include <algorithm>

#include "crumble/sim/simulation.hpp"

namespace crumble {

double Simulation::stored_energy() const noexcept {
  return spring_energy(network_, state_) + kinetic_energy(network_, state_);
}

// Moving nodes onto a tool is work that the tool does.
void Simulation::audit_projection() noexcept {
  const double now = stored_energy();
  ledger_.tool_work += now - ledger_.stored;
  ledger_.stored = now;
}

// The solve stage alone: what remains after the work of reactions and outer forces must not be a gain (the theorem).
void Simulation::audit_solve() noexcept {
  double external_work = 0, reaction_work = 0;
  for (std::size_t i = 0; i < before_solve_.size(); ++i) {
    external_work += dot(state_.external[i], state_.positions[i] - before_solve_[i]);
  }
  for (const NodeConstraint& c : contacts_.constraints()) {
    reaction_work += dot(c.reaction, state_.positions[c.node] - before_solve_[c.node]);
  }
  const double now = stored_energy();
  const double gain = now - ledger_.stored - external_work - reaction_work;
  ledger_.gain_max_relative = std::max(ledger_.gain_max_relative, gain / (ledger_.stored + reference_energy_));
  ledger_.tool_work += reaction_work;
  ledger_.external_work += external_work;
  ledger_.dissipated -= gain;
  ledger_.stored = now;
}

void Simulation::audit_cut() noexcept {
  const double now = stored_energy();
  ledger_.cut += ledger_.stored - now;
  ledger_.stored = now;
}

}  // namespace crumble
