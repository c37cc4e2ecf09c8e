#include "stepping.hpp"

#include <algorithm>
#include <cmath>

#include "record.hpp"

namespace crumble::capi {
namespace {

crumble_result fail_bad_pose(const Call& call, const crumble_pose* poses, std::uint32_t count) noexcept {
  for (std::uint32_t tool = 0; tool < count; ++tool) {
    const crumble_pose& pose = poses[tool];
    for (std::uint32_t i = 0; i < 3; ++i) {
      if (!std::isfinite(pose.position[i])) {
        return call.fail(CRUMBLE_E_BAD_POSE, {"pose ", tool, ": position[", i, "] is ", pose.position[i]});
      }
    }
    if (is_valid(to_pose(pose))) continue;
    const double* q = pose.orientation;
    return call.fail(CRUMBLE_E_BAD_POSE, {"pose ", tool, ": orientation is no unit quaternion: ", q[0], ", ", q[1],
                                          ", ", q[2], ", ", q[3]});
  }
  return call.fail(CRUMBLE_E_BAD_POSE, {"pose"});
}

}  // namespace

crumble_result judge(const Sim& sim, const Call& call, const crumble_pose* poses, std::uint32_t count) noexcept {
  const StepInfo& info = sim.simulation.info();
  if (info.status == Code::bad_pose) return fail_bad_pose(call, poses, count);
  if (info.status == Code::diverged) {
    return call.fail(CRUMBLE_E_DIVERGED,
                     {"node ", info.bad_node, " left the world in step ", info.step + 1, ": reset the simulation"});
  }
  return CRUMBLE_OK;
}

crumble_result take_poses(Sim& sim, const Call& call, const crumble_pose* poses, const crumble_wrench* wrenches,
                          std::uint32_t count) noexcept {
  if (count > 0 && !poses) return call.fail(CRUMBLE_E_NULL, {"pose must not be NULL"});
  if (count > 0 && !wrenches) return call.fail(CRUMBLE_E_NULL, {"wrench must not be NULL"});
  if (sim.poses.size() != count) {
    return call.fail(CRUMBLE_E_OUT_OF_RANGE,
                     {"tool_count is ", count, ", the simulation has ", std::uint64_t{sim.poses.size()}});
  }
  std::transform(poses, poses + count, sim.poses.begin(), to_pose);
  return CRUMBLE_OK;
}

crumble_result tell_step(Sim& sim, const Call& call, std::span<const Pose> poses) noexcept {
  for (const auto& link : sim.readers) link->publisher.publish(sim.simulation);
  if (sim.simulation.info().status != Code{}) return CRUMBLE_OK;
  return record(sim, call, [&](Recording& recording) { recording.add(poses, sim.simulation.state_hash()); });
}

}  // namespace crumble::capi
