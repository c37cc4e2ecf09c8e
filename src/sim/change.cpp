#include "crumble/sim/change.hpp"

#include <algorithm>
#include <string>

#include "crumble/base/text.hpp"

namespace crumble {
namespace {

template <class Value>
void require_same(const char* field, Value now, Value next) {
  if (now == next) return;
  throw Error(Code::state, std::string(field) + " is " + to_text(static_cast<double>(now)) + " and cannot become " +
                               to_text(static_cast<double>(next)) +
                               " once the simulation has been stepped or is in use: reset it first");
}

void require_same(const char* what, bool same) {
  if (!same)
    throw Error(Code::state, std::string(what) + " cannot change once the simulation has been stepped or is in use");
}

void check_change(const SimulationDef& now, const SimulationDef& next) {
  require_same("tau", now.step.tau, next.step.tau);
  require_same("iterations", now.step.iterations, next.step.iterations);
  require_same("precision", static_cast<int>(now.step.precision), static_cast<int>(next.step.precision));
  require_same("the number of tools", now.tools.size(), next.tools.size());
  const auto same_nodes = [](const Attachment& a, const Attachment& b) { return a.nodes == b.nodes; };
  require_same("attachments", std::equal(now.attachments.begin(), now.attachments.end(), next.attachments.begin(),
                                         next.attachments.end(), same_nodes));
  require_same("the mesh", now.mesh.positions == next.mesh.positions && now.mesh.tetrahedra == next.mesh.tetrahedra);
}

SimulationDef checked(const SimulationDef& now, SimulationDef next) {
  check_change(now, next);
  return next;
}

Vector<std::uint8_t> bytes_of(const Solid& solid) {
  ByteWriter out;
  solid->write(out);
  return std::move(out.bytes());
}

bool is_same(const Pose& a, const Pose& b) {
  return a.position == b.position && a.orientation.coeffs() == b.orientation.coeffs();
}

bool is_same(const Tool& a, const Tool& b) {
  const bool one_solid = a.shape.operator->() == b.shape.operator->();
  return is_same(a.offset, b.offset) && (one_solid || bytes_of(a.shape) == bytes_of(b.shape));
}

bool is_same(const Wall& a, const Wall& b) {
  return a.plane.normal == b.plane.normal && a.plane.offset == b.plane.offset;
}

}  // namespace

DefinitionChange::DefinitionChange(const SimulationDef& now, SimulationDef next)
    : next_(checked(now, std::move(next))) {
  const SimulationDef& then = next_.def_;
  for (std::size_t tool = 0; tool < now.tools.size(); ++tool) {
    moved_tools_.push_back(!is_same(now.tools[tool], then.tools[tool]));
  }
  moved_walls_ = !std::equal(now.walls.begin(), now.walls.end(), then.walls.begin(), then.walls.end(),
                             [](const Wall& a, const Wall& b) { return is_same(a, b); });
}

void DefinitionChange::apply_to(Simulation& sim) noexcept {
  sim.adopt(next_, moved_tools_, moved_walls_);
}

void Simulation::adopt(Simulation& next, std::span<const std::uint8_t> moved_tools, bool moved_walls) noexcept {
  const double stored = def_.step.energy_audit ? stored_energy() : 0;
  const bool had_samples = def_.step.surface_samples;
  for (std::uint32_t node = 0; node < network_.node_count(); ++node) {
    if (next.network_.fixed[node] && !network_.fixed[node]) solver_->place(node, solver_->position(node), Vec3::Zero());
  }
  swap_definition(next);
  solver_->redefine(*next.solver_);
  contacts_.redefine(next.contacts_, moved_tools, moved_walls);
  if (balls_ && next.balls_) {
    balls_->redefine(*next.balls_);
  } else {
    balls_.swap(next.balls_);
  }
  apply_node_forces();
  renew_shares();
  renew_fragment_states();
  const std::span<const std::uint32_t> cuts = list_cuts(next.new_cuts_);
  if (had_samples != def_.step.surface_samples) contacts_.note_cut(cuts);
  const bool has_new_balls = balls_ && !next.balls_;
  regroup(last_step(), has_new_balls ? cuts : std::span<const std::uint32_t>());
  counters_.guarded_nodes = coefficients_.guarded_nodes;
  forget_copies();
  if (!def_.step.energy_audit) return;
  ledger_.external_work += stored_energy() - stored;
  ledger_.stored = stored_energy();
}

// All but the mesh, which is the same: a drawing thread may be reading it.
void Simulation::swap_definition(Simulation& next) noexcept {
  std::swap(def_.material, next.def_.material);
  std::swap(def_.mass_rule, next.def_.mass_rule);
  def_.fixed_nodes.swap(next.def_.fixed_nodes);
  std::swap(def_.gravity, next.def_.gravity);
  def_.walls.swap(next.def_.walls);
  def_.tools.swap(next.def_.tools);
  std::swap(def_.ball_friction, next.def_.ball_friction);
  std::swap(def_.step, next.def_.step);
  std::swap(network_, next.network_);
  std::swap(coefficients_, next.coefficients_);
  std::swap(layout_hash_, next.layout_hash_);
  std::swap(reference_energy_, next.reference_energy_);
  std::swap(fade_substeps_, next.fade_substeps_);
}

// The solver has mended all springs.
void Simulation::renew_shares() noexcept {
  stiffnesses_.assign(network_.stiffnesses.begin(), network_.stiffnesses.end());
  for (std::uint32_t s = 0; s < intact_.size(); ++s) {
    if (!intact_[s]) set_share(s, 0);
  }
  for (Fading& fading : fading_) {
    fading.substeps_left = std::min(fading.substeps_left, fade_substeps_);
    set_share(fading.spring, static_cast<double>(fading.substeps_left) / (fade_substeps_ + 1));
  }
}

// The solver has freed all nodes, and those that were fixed may be no longer.
void Simulation::renew_fragment_states() noexcept {
  counters_.removed_nodes = 0;
  for (std::uint32_t node = 0; node < network_.node_count(); ++node) {
    const std::uint32_t fragment = fragments_.labels()[node];
    if (fragment == kNoFragment) {
      take_away(node);
    } else if (fragment_states_[fragment] == FragmentState::asleep) {
      let_sleep(node);
    }
  }
}

std::span<const std::uint32_t> Simulation::list_cuts(std::span<std::uint32_t> room) const noexcept {
  std::size_t count = 0;
  for (std::uint32_t spring = 0; spring < intact_.size(); ++spring) {
    if (!intact_[spring]) room[count++] = spring;
  }
  return room.first(count);
}

}  // namespace crumble
