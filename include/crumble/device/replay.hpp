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

enum class ReplayClock : std::uint8_t {
  step_locked = 0,  // read k gives the motion k ticks after `from`
  realtime = 1,     // a read gives the motion as long after `from` as the first read is ago
  fast = 2,         // a read gives the next row of the window: through a file as fast as one reads
};

struct ReplayOptions {
  std::optional<double> from = {};  // s, in the trajectory's own time; the first row's when absent
  std::optional<double> to = {};    // s, > from; the last row's when absent
  EndPolicy end = EndPolicy::hold;
  ReplayClock clock = ReplayClock::step_locked;
};

/// A trajectory as a device. What a sample holds is either a row as recorded, with its velocities where the trajectory
/// has them and the curve's where not, or a point of a PoseCurve, flagged resampled, with the curve's velocities and
/// the buttons and flags of the last row passed. Force and torque of the rows are not played: they are what somebody
/// was made to feel, not what the hand did. Time is counted from `from`, and goes on through the laps of a loop.
///
/// Step-locked: time k * tick, and two replays give the same bits. When the rows of the window are on the ticks (each
/// within 1e-6 tick) sample k is row k; otherwise all are resampled.
/// Realtime: the wall clock's time, always resampled. A read less than half a tick after the last sample has no new
/// one, unless the motion is over.
/// Fast: each row of the window at its own time, never resampled. A loop leaves out a row at `to`, where the next lap
/// begins.
///
/// Throws Error: what PoseCurve throws, invalid_value or out_of_range for the tick and for a window that is empty or
/// leaves the rows; empty for a window without a row to play fast.
std::unique_ptr<Device> open_replay(const Trajectory& trajectory, const ReplayOptions& options, double tick);

}  // namespace crumble
