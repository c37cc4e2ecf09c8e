// One step, in the order of the paper's section 2.6. Read this file first.
#include <algorithm>

#include "crumble/base/clock.hpp"
#include "crumble/fracture/cut.hpp"
#include "crumble/sim/simulation.hpp"

namespace crumble {
namespace {

// Adds the wall time of `stage` to its place in the profile.
template <class Stage>
void timed(double& seconds, Stage&& stage) noexcept {
  const double start = wall_seconds();
  stage();
  seconds += wall_seconds() - start;
}

}  // namespace

const StepInfo& Simulation::step(std::span<const Pose> poses) noexcept {
  if (!accept(poses)) return info_;
  begin_step();
  for (std::uint32_t substep = 1; substep <= coefficients_.substeps; ++substep) {
    // (1) the tools go where the hand moved them
    timed(profile_.move_tool, [&] { move_tools(poses, substep); });

    // (2) nodes that came to lie inside a tool are moved to its surface
    for (std::uint32_t place = 0; place < contacts_.place_count(); ++place) {
      timed(profile_.find_contacts, [&] { contacts_.find(place, state_.positions); });
      timed(profile_.project_contacts, [&] { contacts_.project(state_.positions, state_.velocities); });
    }
    if (def_.step.energy_audit) audit_projection();

    // (3) the network finds its new positions, Eqs (3) to (5)
    for (std::uint32_t iteration = 0; iteration < def_.step.iterations; ++iteration) {
      timed(profile_.solve_network, [&] { solve_network(); });
      if (def_.step.energy_audit) audit_solve();
    }

    // (4) springs beyond their greatest length are cut, Eq (8)
    timed(profile_.cut_springs, [&] { cut_springs(); });
    if (def_.step.energy_audit) audit_cut();
  }
  // (5) the forces on the tools are summed for the hand, Eqs (6) and (7)
  timed(profile_.sum_reaction, [&] { sum_reaction(); });
  timed(profile_.finish_step, [&] { finish_step(); });
  return info_;
}

void Simulation::move_tools(std::span<const Pose> poses, std::uint32_t substep) noexcept {
  const double progress = static_cast<double>(substep) / coefficients_.substeps;
  for (std::size_t tool = 0; tool < poses.size(); ++tool) {
    const Pose target = renormalized(poses[tool]);
    const Pose here = substep == coefficients_.substeps ? target : interpolate(start_poses_[tool], target, progress);
    contacts_.move_tool(tool, here, coefficients_.substep);
  }
}

void Simulation::solve_network() noexcept {
  if (def_.step.energy_audit) before_solve_ = state_.positions;
  solver_.solve(network_, coefficients_, state_, contacts_.constraints());
}

void Simulation::cut_springs() noexcept {
  const std::uint32_t before = info_.new_cuts;
  const std::span<std::uint32_t> free_places = std::span(new_cuts_).subspan(before);
  info_.new_cuts += static_cast<std::uint32_t>(
      crumble::cut_springs(state_.positions, network_.springs, squared_limits_, intact_, free_places));
  for (const std::uint32_t spring : new_cuts().last(info_.new_cuts - before))
    fading_.push_back({spring, fade_substeps_ + 1});
  fade_cut_springs();
}

// A spring that vanishes at once kicks the hand by up to k l0 (l_p - 1), 0.04 N in the paper's cube and several at a
// time. Its stiffness goes to 0 in equal parts instead. That only takes energy out, so the theorem holds.
void Simulation::fade_cut_springs() noexcept {
  for (Fading& fading : fading_) {
    --fading.substeps_left;
    state_.stiffnesses[fading.spring] =
        network_.stiffnesses[fading.spring] * fading.substeps_left / (fade_substeps_ + 1);
  }
  const auto pulling =
      std::find_if(fading_.begin(), fading_.end(), [](const Fading& f) { return f.substeps_left > 0; });
  fading_.erase(fading_.begin(), pulling);
}

}  // namespace crumble
