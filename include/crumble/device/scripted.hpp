// Devices that need no hardware and no file. Both are step-locked: read k (from 0) gives time k * tick.
#pragma once

#include <memory>

#include "crumble/device/device.hpp"

namespace crumble {

/// A device that stays at `pose` for ever. `tick` in seconds.
/// Throws Error: bad_pose; invalid_value or out_of_range for a tick that is not positive.
std::unique_ptr<Device> open_null(const Pose& pose, double tick);

/// From `start` along `direction` at constant speed for `depth` metres, then still for `hold` seconds, then finished.
struct PressOptions {
  Pose start = {};              // m, device frame
  Vec3 direction = {0, -1, 0};  // any length but zero
  double speed = 1e-3;          // m/s, > 0
  double depth = 0.03;          // m, > 0; to press for a given duration use speed * duration
  double hold = 0;              // s, >= 0
};

/// Throws Error naming the field of the option (bad_pose, invalid_value, out_of_range), or the tick.
std::unique_ptr<Device> open_press(const PressOptions& options, double tick);

}  // namespace crumble
