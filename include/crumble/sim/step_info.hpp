// What a step tells of itself.
#pragma once

#include <cstdint>

#include "crumble/base/error.hpp"
#include "crumble/base/vec.hpp"

namespace crumble {

/// What the body does to a tool: force in N, torque in N m about the tool's origin, in scene axes.
struct Wrench {
  Vec3 force = Vec3::Zero();
  Vec3 torque = Vec3::Zero();
};

/// What the last step did. The force is valid whatever the flags say.
enum StepFlag : std::uint32_t {
  // a tool moved more than 8 half thicknesses: its contact is suspended; or an attachment at more than
  // Contacts::kMaxAttachedSpeed: it has taken hold of its nodes anew
  kToolJumped = 1u << 0,
  kContactSuspended = 1u << 1,  // a tool that jumped, or began inside the body, has not been outside since
  kGuarded = 1u << 2,           // the guard raised the drag of some nodes (see Counters::guarded_nodes)
};
struct StepInfo {
  Code status{};               // 0; bad_pose: nothing moved, force 0; diverged: frozen until reset
  std::uint32_t flags = 0;     // StepFlag bits
  std::uint64_t step = 0;      // steps done since the start
  double time = 0;             // simulated seconds
  std::uint32_t contacts = 0;  // nodes that tools and attachments hold
  std::uint32_t new_cuts = 0;  // springs cut in this step
  std::uint32_t bad_node = 0;  // with status diverged: the first node that left the world
};

/// What came of several steps.
struct AdvanceReport {
  std::uint32_t steps = 0;    // done
  std::uint32_t dropped = 0;  // for want of time: simulated time lags by so many
  std::uint32_t flags = 0;    // StepFlag bits of all of them
  std::uint32_t new_cuts = 0;
  double seconds = 0;  // wall time
};

/// Wall seconds that the stages of the last step took; same names and order as in step.cpp.
struct StepProfile {
  double move_tool = 0;
  double find_contacts = 0;
  double project_contacts = 0;
  double touch_fragments = 0;
  double solve_network = 0;
  double cut_springs = 0;
  double sum_reaction = 0;
  double finish_step = 0;
};

/// Sums since the start: what was guarded, clamped, suspended or refused.
struct Counters {
  std::uint64_t guarded_nodes = 0;  // nodes with drag raised by the guard (a property of the body and tau)
  std::uint64_t cuts = 0;           // springs cut
  std::uint64_t tool_jumps = 0;
  std::uint64_t suspended_steps = 0;  // steps in which some tool's contact was suspended
  std::uint64_t bad_poses = 0;        // steps refused for a pose that is not finite or not a rotation
  std::uint64_t dropped_events = 0;   // in steps with more than kMaxEvents of them
  std::uint64_t asleep = 0;           // fragments, now
  std::uint64_t woken = 0;            // fragments, by tools and by fragments that hit them
  std::uint64_t removed = 0;          // fragments
  std::uint64_t removed_nodes = 0;
  std::uint64_t dropped_steps = 0;  // by advance(), for want of time
};

}  // namespace crumble
