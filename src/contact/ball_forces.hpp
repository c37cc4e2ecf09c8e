// What two balls that touch do to each other, for a block of pairs at a time.
#pragma once

#include <cstddef>

#include "crumble/contact/tool.hpp"

namespace crumble {

// Of the pairs' first balls against their second ones. One array per number, so that the compiler can take several
// pairs at once; their sums are the same either way.
struct BallBlock {
  static constexpr std::size_t kSize = 128;
  using Row = double[kSize];

  Row stiffness;                  // N/m
  Row reach;                      // square of the contact distance
  Row x, y, z;                    // distance, metres; becomes the normal
  Row vx, vy, vz;                 // relative velocity, m/s
  Row shear_x, shear_y, shear_z;  // of the friction's spring, metres; becomes that after the step
  Row fx, fy, fz;                 // out: force, N
  Row approach;                   // out: m/s
};

/// For the first `count` pairs of the block, rounded up to a multiple of 8: what lies there must be finite.
using BallLaw = void (*)(BallBlock& block, std::size_t count, const Friction& friction, double tau) noexcept;

/// The fastest that this processor runs.
BallLaw ball_law() noexcept;
/// That which every processor runs; for tests.
BallLaw baseline_ball_law() noexcept;

}  // namespace crumble
