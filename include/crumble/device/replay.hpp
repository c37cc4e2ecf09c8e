// A trajectory played back as a device. Open loop: the recorded hand does not feel our force.
#pragma once

#include <memory>
#include <optional>

#include "crumble/device/trajectory.hpp"

namespace crumble {

enum class EndPolicy : std::uint8_t {
  hold = 0,  // the last pose stays, at rest, and read returns finished
  loop = 1,  // starts again; the pose jumps when the two ends of the window differ
};

struct ReplayOptions {
  std::optional<double> from = {};  // s, in the trajectory's own time; the first row's when absent
  std::optional<double> to = {};    // s, > from; the last row's when absent
  EndPolicy end = EndPolicy::hold;
};

/// Step-locked replay: read k (from 0) gives the motion at from + k * tick, and two replays give the same bits.
///
/// When the rows of the window are just that (each within 1e-6 tick of its time) sample k is row k as recorded, with
/// its velocities where the trajectory has them. Otherwise every sample comes from a PoseCurve and is flagged
/// resampled; its velocities are the curve's derivatives, and buttons and flags are those of the last row passed. Force
/// and torque of the rows are not played: they are what somebody was made to feel, not what the hand did.
///
/// Throws Error: what PoseCurve throws, invalid_value or out_of_range for the tick and for a window that is empty or
/// leaves the rows.
std::unique_ptr<Device> open_replay(const Trajectory& trajectory, const ReplayOptions& options, double tick);

}  // namespace crumble
