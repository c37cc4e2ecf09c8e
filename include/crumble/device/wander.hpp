// A hand that goes from one random place to the next, for ever.
#pragma once

#include <memory>

#include "crumble/device/device.hpp"

namespace crumble {

/// Moves of least jerk (Flash and Hogan, J. Neurosci. 5, 1985) from random point to random point of a box, with random
/// pauses. No move is shorter than an eighth of the box's diagonal. With max_turn it is tilted at each point, about a
/// random axis and by a random angle from how it stood at the start, and turns on the way.
struct WanderOptions {
  Pose start = {};                       // m, device frame
  Vec3 low = {-0.02, -0.02, -0.02};      // m, from start: corners of the box, <= 0
  Vec3 high = {0.02, 0.02, 0.02};        // and >= 0
  double slowest = 0.02, fastest = 0.1;  // m/s, > 0: mean speed of one move, which peaks at 1.875 times that
  double max_pause = 0.5;                // s, >= 0
  double max_turn = 0;                   // rad, in [0, pi]
  std::uint64_t seed = 0;
  double seconds = 0;  // s, >= 0; 0: without end
};

/// Step-locked: read k (from 0) gives time k * tick; two devices of one seed give the same bits. A move that would end
/// after `seconds` is not begun: it rests until then, and is finished.
/// Throws Error naming the field of the option (bad_pose, invalid_value, out_of_range), or the tick. Out of range is
/// also a fastest move that may last less than a tick.
std::unique_ptr<Device> open_wander(const WanderOptions& options, double tick);

}  // namespace crumble
