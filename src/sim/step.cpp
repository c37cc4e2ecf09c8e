// One step, in the order of the paper's section 2.6. Read this file first.
#include <algorithm>

#include "crumble/base/clock.hpp"
#include "crumble/fracture/cut.hpp"
#include "crumble/sim/simulation.hpp"

namespace crumble {
namespace {

// Wall time between the stages, each to its place in the profile.
class Laps {
 public:
  void end(double& seconds) noexcept {
    const double now = wall_seconds();
    seconds += now - last_;
    last_ = now;
  }
  void skip() noexcept { last_ = wall_seconds(); }

 private:
  double last_ = wall_seconds();
};

}  // namespace

const StepInfo& Simulation::step(std::span<const Pose> poses) noexcept {
  if (!accept(poses)) return info_;
  begin_step();
  Laps laps;
  for (std::uint32_t substep = 1; substep <= coefficients_.substeps; ++substep) {
    // (1) the tools go where the hand moved them
    move_tools(poses, substep);
    laps.end(profile_.move_tool);

    // (2) nodes that came to lie inside a tool are moved to its surface
    for (std::uint32_t place = 0; place < contacts_.place_count(); ++place) {
      contacts_.find(place, *solver_);
      wake_roused();
      laps.end(profile_.find_contacts);
      contacts_.project(*solver_);
      laps.end(profile_.project_contacts);
    }
    if (def_.step.energy_audit) audit_projection(), laps.skip();

    for (std::uint32_t iteration = 0; iteration < def_.step.iterations; ++iteration) {
      touch_fragments();
      laps.end(profile_.touch_fragments);

      // (3) the network finds its new positions, Eqs (3) to (5), and on the way the springs that are too long, Eq (8)
      solve_network();
      laps.end(profile_.solve_network);
      if (def_.step.energy_audit) audit_solve(), laps.skip();

      // (4) these are cut
      cut_springs();
      laps.end(profile_.cut_springs);
      if (def_.step.energy_audit) audit_cut(), laps.skip();
    }

    // no step ends with a node inside a tool
    contacts_.push_out(*solver_);
    laps.end(profile_.project_contacts);
    if (def_.step.energy_audit) audit_projection(), laps.skip();
  }
  track_fragments();
  laps.end(profile_.cut_springs);

  // (5) the forces on the tools are summed for the hand, Eqs (6) and (7)
  sum_reaction();
  laps.end(profile_.sum_reaction);
  finish_step();
  laps.end(profile_.finish_step);
  return info_;
}

void Simulation::move_tools(std::span<const Pose> poses, std::uint32_t substep) noexcept {
  const double progress = static_cast<double>(substep) / coefficients_.substeps;
  for (std::size_t tool = 0; tool < poses.size(); ++tool) {
    const Pose target = renormalized(poses[tool]);
    const Pose here = substep == coefficients_.substeps ? target : interpolate(start_poses_[tool], target, progress);
    contacts_.move_holder(tool, here, coefficients_.substep);
  }
}

void Simulation::solve_network() noexcept {
  forget_copies();
  if (def_.step.energy_audit) audit_before_solve();
  solver_->solve(contacts_.constraints());
}

// A spring that was found where the forces are worked out has pulled less in this substep already; one that is found
// after the move will in the next.
void Simulation::cut_springs() noexcept {
  const bool after_move = def_.step.cut_test == CutTest::after_move;
  if (after_move) solver_->find_overlong(def_.material.length_limit);
  const std::uint32_t before = info_.new_cuts;
  info_.new_cuts += static_cast<std::uint32_t>(
      crumble::cut_springs(solver_->overlong(), intact_, std::span(new_cuts_).subspan(before)));
  contacts_.note_cut(new_cuts().subspan(before));
  fade_cut_springs();
  for (const std::uint32_t spring : new_cuts().last(info_.new_cuts - before)) {
    log_cut(spring);
    fading_.push_back({spring, fade_substeps_ + after_move});
    fade(fading_.back());
  }
  drop_faded();
}

// A spring that vanishes at once kicks the hand by up to k l0 (l_p - 1), 0.04 N in the paper's cube and several at a
// time. Its stiffness goes to 0 in equal parts instead. That only takes energy out, so the theorem holds.
void Simulation::fade_cut_springs() noexcept {
  for (Fading& fading : fading_) fade(fading);
}

void Simulation::fade(Fading& fading) noexcept {
  if (fading.substeps_left > 0) --fading.substeps_left;
  set_share(fading.spring, static_cast<double>(fading.substeps_left) / (fade_substeps_ + 1));
}

void Simulation::drop_faded() noexcept {
  const auto pulling =
      std::find_if(fading_.begin(), fading_.end(), [](const Fading& f) { return f.substeps_left > 0; });
  fading_.erase(fading_.begin(), pulling);
}

void Simulation::set_share(std::uint32_t spring, double share) noexcept {
  stiffnesses_[spring] = network_.stiffnesses[spring] * share;
  solver_->set_share(spring, share);
}

}  // namespace crumble
