// What a servo loop calls.
#include <algorithm>

#include "defs.hpp"
#include "kernels.hpp"
#include "stepping.hpp"

namespace crumble::capi {
namespace {

crumble_result step_tools(const char* function, crumble_sim sim, const crumble_pose* poses, crumble_wrench* wrenches,
                          std::uint32_t count) noexcept {
  // before anything can fail: a loop that ignores results must not go on with an old force
  if (wrenches) std::fill_n(wrenches, count, crumble_wrench{});
  return with<Sim>(function, sim, [&](Sim& s, const Call& call) -> crumble_result {
    crumble_result result = take_poses(s, call, poses, wrenches, count);
    if (result != CRUMBLE_OK) return result;
    s.simulation.step(s.poses);
    result = judge(s, call, poses, count);
    if (const crumble_result told = tell_step(s, call, s.poses); result == CRUMBLE_OK) result = told;
    if (result != CRUMBLE_OK) return result;
    for (std::uint32_t tool = 0; tool < count; ++tool) wrenches[tool] = to_c(s.simulation.wrench(tool));
    return CRUMBLE_OK;
  });
}

crumble_step_info to_c(const StepInfo& info) {
  crumble_step_info out{};
  out.status = static_cast<std::int32_t>(info.status);
  out.step = info.step;
  out.time = info.time;
  out.flags = info.flags;
  out.contacts = info.contacts;
  out.new_cuts = info.new_cuts;
  out.bad_node = info.bad_node;
  return out;
}

static_assert(std::uint32_t{CRUMBLE_STEP_TOOL_JUMPED} == kToolJumped);
static_assert(std::uint32_t{CRUMBLE_STEP_CONTACT_SUSPENDED} == kContactSuspended);
static_assert(std::uint32_t{CRUMBLE_STEP_GUARDED} == kGuarded);
static_assert((CRUMBLE_STEP_DROPPED & (kToolJumped | kContactSuspended | kGuarded)) == 0);

crumble_counters to_c(const Counters& counters) {
  crumble_counters out{};
  out.guarded_nodes = counters.guarded_nodes;
  out.cuts = counters.cuts;
  out.tool_jumps = counters.tool_jumps;
  out.suspended_steps = counters.suspended_steps;
  out.bad_poses = counters.bad_poses;
  out.dropped_events = counters.dropped_events;
  out.asleep = counters.asleep;
  out.woken = counters.woken;
  out.removed = counters.removed;
  out.removed_nodes = counters.removed_nodes;
  out.dropped_steps = counters.dropped_steps;
  return out;
}

crumble_profile to_c(const StepProfile& profile) {
  return {0,
          0,
          profile.move_tool,
          profile.find_contacts,
          profile.project_contacts,
          profile.solve_network,
          profile.cut_springs,
          profile.sum_reaction,
          profile.finish_step,
          profile.touch_fragments};
}

crumble_sim_info describe_solver(const Simulation& simulation) {
  const LayoutReport layout = simulation.layout();
  crumble_sim_info out{};
  out.kernel = kernel_number(simulation.kernel());
  out.springs_in_segments = static_cast<std::uint32_t>(layout.springs_in_segments);
  out.lanes = static_cast<std::uint32_t>(layout.lanes);
  out.segments = static_cast<std::uint32_t>(layout.segments);
  out.batches = static_cast<std::uint32_t>(layout.batches);
  out.partitions = layout.partitions;
  out.sorted = layout.sorted;
  return out;
}

}  // namespace
}  // namespace crumble::capi

using namespace crumble::capi;

crumble_result crumble_sim_step(crumble_sim sim, const crumble_pose* pose, crumble_wrench* wrench) {
  return step_tools(__func__, sim, pose, wrench, 1);
}

crumble_result crumble_sim_step_tools(crumble_sim sim, const crumble_pose* poses, crumble_wrench* wrenches,
                                      uint32_t tool_count) {
  return step_tools(__func__, sim, poses, wrenches, tool_count);
}

crumble_result crumble_sim_get_step_info(crumble_sim sim, crumble_step_info* info) {
  return with<Sim>(__func__, sim, [&](const Sim& s, const Call&) {
    write_struct("info", info, to_c(s.simulation.info()));
    return CRUMBLE_OK;
  });
}

crumble_result crumble_sim_get_counters(crumble_sim sim, crumble_counters* counters) {
  return with<Sim>(__func__, sim, [&](const Sim& s, const Call&) {
    write_struct("counters", counters, to_c(s.simulation.counters()));
    return CRUMBLE_OK;
  });
}

crumble_result crumble_sim_get_energy(crumble_sim sim, crumble_energy* energy) {
  return with<Sim>(__func__, sim, [&](const Sim& s, const Call& call) -> crumble_result {
    if (!s.simulation.definition().step.energy_audit) return call.fail(CRUMBLE_E_STATE, {"energy_audit is 0"});
    const crumble::EnergyLedger& ledger = s.simulation.ledger();
    write_struct("energy", energy,
                 crumble_energy{0, 0, ledger.stored, ledger.tool_work, ledger.external_work, ledger.dissipated,
                                ledger.cut, ledger.gain_max_relative});
    return CRUMBLE_OK;
  });
}

crumble_result crumble_sim_get_profile(crumble_sim sim, crumble_profile* profile) {
  return with<Sim>(__func__, sim, [&](const Sim& s, const Call&) {
    write_struct("profile", profile, to_c(s.simulation.profile()));
    return CRUMBLE_OK;
  });
}

crumble_result crumble_sim_get_info(crumble_sim sim, crumble_sim_info* info) {
  return with<Sim>(__func__, sim, [&](const Sim& s, const Call&) {
    write_struct("info", info, describe_solver(s.simulation));
    return CRUMBLE_OK;
  });
}
