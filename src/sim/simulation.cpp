#include "crumble/sim/simulation.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "crumble/base/hash.hpp"

namespace crumble {
namespace {

std::uint64_t hash_definition(const SimulationDef& def) {
  ByteWriter bytes;
  write_definition(def, bytes);
  Hash hash;
  hash.add(std::span<const std::uint8_t>(bytes.bytes()));
  return hash.value();
}

void check_settings(const SimulationDef& def) {
  for (const Tool& tool : def.tools) check(tool);
  check(def.ball_friction);
  if (!is_finite(def.gravity)) throw Error(Code::invalid_value, "gravity is not finite");
  if (def.step.iterations < 1 || def.step.iterations > 1000) {
    throw Error(Code::out_of_range, "step.iterations must lie in [1, 1000], is " + std::to_string(def.step.iterations));
  }
  if (def.step.iterations > 1 && def.step.policy != TimeStepPolicy::unchecked) {
    throw Error(Code::out_of_range,
                "step.iterations above 1 belong to the paper's mode: set the time-step policy to unchecked");
  }
}

SimulationDef checked(SimulationDef def) {
  check_settings(def);
  return def;
}

// Substeps in which a cut spring still pulls: that in which it is found too long and those after.
std::uint32_t fade_substeps(const StepSettings& settings, const StepCoefficients& coefficients) {
  require_in_range("step.cut_fade", settings.cut_fade, 0, 1);
  return static_cast<std::uint32_t>(std::max(std::floor(settings.cut_fade / coefficients.substep + 0.5) - 1, 0.0));
}

SolverSettings solver_settings(const SimulationDef& def, std::uint32_t fade_substeps) {
  if (def.step.threads < 1 || def.step.threads > 64) {
    throw Error(Code::out_of_range, "step.threads must lie in [1, 64], is " + std::to_string(def.step.threads));
  }
  SolverSettings settings;
  settings.precision = def.step.precision;
  settings.kernel = def.step.kernel;
  settings.threads = def.step.threads;
  settings.host_threads = def.step.host_threads;
  if (def.step.cut_test == CutTest::with_forces) settings.length_limit = def.material.length_limit;
  settings.cut_share = static_cast<double>(fade_substeps) / (fade_substeps + 1);
  return settings;
}

// A cut and a split per spring at most, a beginning and an end of contact per node.
std::size_t event_capacity(const SpringNetwork& network) {
  return std::min(Simulation::kMaxEvents, 2 * (network.spring_count() + network.node_count()));
}

}  // namespace

Simulation::Simulation(SimulationDef def)
    : def_(checked(std::move(def))),
      network_(make_network(def_.mesh, def_.material, def_.mass_rule, def_.fixed_nodes)),
      coefficients_(make_coefficients(network_, def_.step.tau, def_.step.policy)),
      layout_hash_(hash_definition(def_)),
      reference_energy_(reference_energy(network_)),
      fade_substeps_(fade_substeps(def_.step, coefficients_)),
      solver_(NetworkSolver::make(network_, coefficients_, def_.mesh.positions, solver_settings(def_, fade_substeps_))),
      contacts_(def_.tools, def_.walls, network_.fixed, def_.step.contact_rule, def_.attachments,
                def_.step.surface_samples ? SurfaceSamples(def_.mesh) : SurfaceSamples()),
      balls_(make_balls()),
      ball_positions_(network_.node_count()),
      ball_velocities_(network_.node_count()),
      ball_fragments_(network_.node_count()),
      stiffnesses_(network_.stiffnesses),
      node_forces_(network_.node_count()),
      external_(network_.node_count()),
      intact_(network_.spring_count(), 1),
      new_cuts_(network_.spring_count()),
      start_poses_(holder_count()),
      advance_from_(holder_count()),
      advance_to_(holder_count()),
      marks_(network_.node_count()),
      fragments_(network_.node_count(), network_.springs),
      fragment_states_(network_.node_count()),
      loose_first_(network_.node_count() + 1),
      loose_nodes_(network_.node_count()),
      loose_group_of_(network_.node_count()),
      is_debris_(network_.node_count()),
      event_log_(network_.node_count(), event_capacity(network_)),
      wrenches_(holder_count()),
      history_(holder_count()) {
  positions_ = velocities_ = before_solve_ = VecArray(network_.node_count());
  apply_node_forces();
  fading_.reserve(network_.spring_count());
  debris_.reserve(network_.node_count());
  counters_.guarded_nodes = coefficients_.guarded_nodes;
  regroup(0, {});
}

bool Simulation::accept(std::span<const Pose> poses) noexcept {
  event_log_.begin_step(info_.step, end_of_step());  // a refused step has no events
  if (info_.status == Code::diverged) return false;
  const bool good = poses.size() == holder_count() && std::all_of(poses.begin(), poses.end(), is_valid);
  info_.status = good ? Code{} : Code::bad_pose;
  if (good) return true;
  ++counters_.bad_poses;
  std::fill(wrenches_.begin(), wrenches_.end(), Wrench{});
  return false;
}

void Simulation::begin_step() noexcept {
  profile_ = {};
  info_.flags = 0;
  info_.new_cuts = 0;
  for (std::size_t tool = 0; tool < start_poses_.size(); ++tool) start_poses_[tool] = contacts_.pose(tool);
  forget_copies();
}

double Simulation::end_of_step() const noexcept {
  return static_cast<double>(info_.step + 1) * (def_.step.tau * def_.step.iterations);
}

// Eq (6): the tool feels the opposite of what it does to the nodes.
void Simulation::sum_reaction() noexcept {
  std::fill(wrenches_.begin(), wrenches_.end(), Wrench{});
  info_.contacts = 0;
  for (const NodeConstraint& c : contacts_.constraints()) {
    if (c.holder == kWorldHolder) continue;
    Wrench& wrench = wrenches_[c.holder];
    wrench.force -= c.reaction;
    wrench.torque -= cross(c.point - contacts_.pose(c.holder).position, c.reaction);
    info_.contacts += c.state != ContactState::released;
  }
  if (!def_.step.mean_force) return;
  for (std::size_t tool = 0; tool < wrenches_.size(); ++tool) {  // Eq (7)
    history_[tool][info_.step % 5] = wrenches_[tool];
    wrenches_[tool] = {};
    for (const Wrench& past : history_[tool]) {
      wrenches_[tool].force += past.force / 5;
      wrenches_[tool].torque += past.torque / 5;
    }
  }
}

void Simulation::finish_step() noexcept {
  contacts_.drop_released();
  log_contacts();
  counters_.dropped_events += event_log_.dropped();
  if (coefficients_.guarded_nodes > 0) info_.flags |= kGuarded;
  for (std::size_t tool = 0; tool < holder_count(); ++tool) {
    if (contacts_.jumped(tool)) info_.flags |= kToolJumped, ++counters_.tool_jumps;
    if (!contacts_.engaged(tool)) info_.flags |= kContactSuspended;
  }
  counters_.suspended_steps += (info_.flags & kContactSuspended) != 0;
  counters_.cuts += info_.new_cuts;
  if (find_divergence()) return;
  info_.time = end_of_step();
  ++info_.step;
}

// A node that would go farther than 1 km, faster than 1 km/s or to what is not a number stays, and stops everything.
bool Simulation::find_divergence() noexcept {
  const auto lost = solver_->lost_node();
  if (!lost) return false;
  std::fill(wrenches_.begin(), wrenches_.end(), Wrench{});
  info_.status = Code::diverged;
  info_.bad_node = *lost;
  return true;
}

VecView Simulation::positions() const noexcept {
  if (!positions_known_) solver_->read_positions(0, positions_);
  positions_known_ = true;
  return positions_;
}

VecView Simulation::velocities() const noexcept {
  if (!velocities_known_) solver_->read_velocities(velocities_);
  velocities_known_ = true;
  return velocities_;
}

VecArray Simulation::forces() const {
  VecArray forces(network_.node_count());
  solver_->read_forces(forces);
  return forces;
}

void Simulation::reset() noexcept {
  solver_->reset();
  clear_node_forces();
  forget_copies();
  stiffnesses_ = network_.stiffnesses;
  std::fill(intact_.begin(), intact_.end(), std::uint8_t{1});
  fading_.clear();
  contacts_.clear();
  fragments_.reset();
  std::fill(fragment_states_.begin(), fragment_states_.end(), FragmentState::active);
  std::fill(wrenches_.begin(), wrenches_.end(), Wrench{});
  std::fill(history_.begin(), history_.end(), std::array<Wrench, 5>{});
  info_ = {};
  profile_ = {};
  ledger_ = {};
  counters_ = {};
  counters_.guarded_nodes = coefficients_.guarded_nodes;
  event_log_.restart(0, {});
  if (balls_) balls_->reset();
  regroup(0, {});
}

}  // namespace crumble
