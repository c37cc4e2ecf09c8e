// Devices that need no hardware and no file. All are step-locked: read k (from 0) gives time k * tick.
#pragma once

#include <memory>

#include "crumble/base/memory.hpp"
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

/// Where a path comes by. A turn by several revolutions is a turn by that many.
struct PathPoint {
  double time = 0;           // s, from 0 on, increasing from point to point
  Vec3 move = Vec3::Zero();  // m, from where it started
  Vec3 turn = Vec3::Zero();  // unit axis times radians, from how it stood when it started, about its own origin
};

/// From `start` (at time 0) straight to each point, at constant speed; turns about one axis are turned at constant
/// speed too. Then finished. A point with the move and turn of the one before holds still.
struct PathOptions {
  Pose start = {};           // m, device frame
  Vector<PathPoint> points;  // one at least
};

/// Throws Error naming the field of the option (bad_pose, empty, invalid_value, out_of_range), or the tick.
std::unique_ptr<Device> open_path(const PathOptions& options, double tick);

}  // namespace crumble
