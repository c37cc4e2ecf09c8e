// Several steps in one call.
#include <algorithm>
#include <cmath>

#include "defs.hpp"
#include "stepping.hpp"

namespace crumble::capi {
namespace {

constexpr std::uint32_t kMostSteps = 100000;  // 100 s of the default step

crumble_result check(const Call& call, std::uint32_t steps, double budget) noexcept {
  if (steps < 1 || steps > kMostSteps) {
    return call.fail(CRUMBLE_E_OUT_OF_RANGE, {"steps must lie in [1, ", kMostSteps, "], is ", steps});
  }
  if (!std::isfinite(budget)) return call.fail(CRUMBLE_E_INVALID_VALUE, {"budget is not finite: ", budget});
  if (budget < 0) return call.fail(CRUMBLE_E_OUT_OF_RANGE, {"budget must not be negative, is ", budget});
  return CRUMBLE_OK;
}

crumble_advance_info describe(const AdvanceReport& report, double time) {
  crumble_advance_info out{};
  out.flags = report.flags | (report.dropped > 0 ? std::uint32_t{CRUMBLE_STEP_DROPPED} : 0u);
  out.steps = report.steps;
  out.dropped = report.dropped;
  out.new_cuts = report.new_cuts;
  out.seconds = report.seconds;
  out.time = time;
  return out;
}

// Tells readers and the recording of each step.
struct Watch {
  Sim& sim;
  const Call& call;
  crumble_result result = CRUMBLE_OK;

  static void after_step(std::span<const Pose> poses, void* self) noexcept {
    auto& [sim, call, result] = *static_cast<Watch*>(self);
    if (const crumble_result told = tell_step(sim, call, poses); told != CRUMBLE_OK) result = told;
  }
};

}  // namespace
}  // namespace crumble::capi

using namespace crumble;
using namespace crumble::capi;

crumble_result crumble_sim_advance(crumble_sim sim, const crumble_pose* poses, crumble_wrench* wrenches,
                                   uint32_t tool_count, uint32_t steps, double budget, crumble_advance_info* info) {
  if (wrenches) std::fill_n(wrenches, tool_count, crumble_wrench{});
  return with<Sim>(__func__, sim, [&](Sim& s, const Call& call) -> crumble_result {
    if (info) check_struct_size("info", info->struct_size);
    if (const crumble_result bad = check(call, steps, budget); bad != CRUMBLE_OK) return bad;
    if (const crumble_result bad = take_poses(s, call, poses, wrenches, tool_count); bad != CRUMBLE_OK) return bad;
    Watch watch{s, call};
    const AdvanceReport report = s.simulation.advance(s.poses, steps, budget, s.wrenches, {Watch::after_step, &watch});
    if (info) write_struct("info", info, describe(report, s.simulation.info().time));
    if (const crumble_result bad = judge(s, call, poses, tool_count); bad != CRUMBLE_OK) return bad;
    if (watch.result == CRUMBLE_OK) {
      for (std::uint32_t tool = 0; tool < tool_count; ++tool) wrenches[tool] = to_c(s.wrenches[tool]);
    }
    return watch.result;
  });
}
