// What one step and several have in common. They fail without memory: not by exceptions, whose texts take some.
#pragma once

#include <span>

#include "objects.hpp"
#include "rigid.hpp"

namespace crumble::capi {

/// Into sim.poses.
crumble_result take_poses(Sim& sim, const Call& call, const crumble_pose* poses, const crumble_wrench* wrenches,
                          std::uint32_t count) noexcept;
/// What came of the last step, as a result.
crumble_result judge(const Sim& sim, const Call& call, const crumble_pose* poses, std::uint32_t count) noexcept;
/// To readers, and to the recording, which may find no memory.
crumble_result tell_step(Sim& sim, const Call& call, std::span<const Pose> poses) noexcept;

}  // namespace crumble::capi
