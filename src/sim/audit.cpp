// The energy ledger: what each stage did to springs + kinetic energy. Only when StepSettings::energy_audit asks for it.
#include <algorithm>

#include "crumble/sim/simulation.hpp"

namespace crumble {

double Simulation::stored_energy() const noexcept {
  return spring_energy(network_, positions(), stiffnesses_) + kinetic_energy(network_, velocities());
}

// Moving nodes onto a tool is work that the tool does.
void Simulation::audit_projection() noexcept {
  forget_copies();
  const double now = stored_energy();
  ledger_.tool_work += now - ledger_.stored;
  ledger_.stored = now;
}

void Simulation::audit_before_solve() noexcept {
  solver_->read_positions(0, before_solve_);
  solver_->read_velocities(velocities_);
  kinetic_before_solve_ = kinetic_energy(network_, velocities_);
}

// What the springs that were found too long lost before they pulled.
void Simulation::audit_overlong() noexcept {
  if (def_.step.cut_test == CutTest::after_move) return;
  for (const std::uint32_t spring : solver_->overlong()) {
    stiffnesses_[spring] = network_.stiffnesses[spring] * fade_substeps_ / (fade_substeps_ + 1);
  }
  const double before = spring_energy(network_, before_solve_, stiffnesses_) + kinetic_before_solve_;
  ledger_.cut += ledger_.stored - before;
  ledger_.stored = before;
}

// The solve stage alone: what remains after the work of reactions and outer forces must not be a gain (the theorem).
void Simulation::audit_solve() noexcept {
  audit_overlong();
  double external_work = 0, reaction_work = 0;
  const VecView after = positions();
  for (std::size_t i = 0; i < before_solve_.size(); ++i) {
    external_work += dot(external_[i], after[i] - before_solve_[i]);
  }
  for (std::size_t k = 0; balls_ && k < balls_->pushed().size(); ++k) {
    const std::uint32_t node = balls_->pushed()[k];
    external_work += dot(balls_->forces()[k], after[node] - before_solve_[node]);
  }
  for (const NodeConstraint& c : contacts_.constraints()) {
    reaction_work += dot(c.reaction, after[c.node] - before_solve_[c.node]);
  }
  reaction_work += solver_->holder_work();
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
