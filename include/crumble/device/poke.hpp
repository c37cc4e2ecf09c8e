// Straight pokes, as a finger does them.
#pragma once

#include <memory>

#include "crumble/device/device.hpp"

namespace crumble {

/// From `start` along `direction` to `depth` and back, `count` times. In and out are moves of least jerk (Flash and
/// Hogan, J. Neurosci. 5, 1985): at rest at both ends, fastest half-way, with 1.875 times the mean speed.
struct PokeOptions {
  Pose start = {};              // m, device frame
  Vec3 direction = {0, -1, 0};  // any length but zero
  double depth = 0.01;          // m, > 0
  double in = 0.5;              // s, > 0: time to go in
  double hold = 0.5;            // s, >= 0: still at depth
  double out = 0.5;             // s, > 0: time to come back
  double rest = 0.5;            // s, >= 0: still at start between two pokes
  std::uint32_t count = 1;      // >= 1
};

/// Step-locked: read k (from 0) gives time k * tick. Finished when the last poke is back at `start`.
/// Throws Error naming the field of the option (bad_pose, invalid_value, out_of_range), or the tick. Out of range is
/// also more than 1e6 m/s.
std::unique_ptr<Device> open_poke(const PokeOptions& options, double tick);

}  // namespace crumble
