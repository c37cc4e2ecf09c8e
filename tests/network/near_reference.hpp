// A solver against the reference.
#pragma once

#include <gtest/gtest.h>

#include <string>

#include "network/reference.hpp"

namespace crumble {

// Sums of a different order, in floats of half the digits: equal but for rounding of what pulls at the node.
inline void expect_near(const NetworkSolver& solver, const Reference& before, const Reference& after,
                        const StepCoefficients& c, double epsilon, const std::string& name) {
  for (std::uint32_t i = 0; i < after.positions.size(); ++i) {
    const double gain = c.force_gain[i] * after.pulls[i], way = c.drift[i] * norm(before.velocities[i]);
    const double speed_gain = c.velocity_gain[i] * after.pulls[i], speed = norm(before.velocities[i]);
    const double tolerance = epsilon * (gain + way + epsilon * norm(before.positions[i]));
    ASSERT_LE(norm(solver.position(i) - after.positions[i]), tolerance + 1e-16 * norm(after.positions[i]))
        << name << ", node " << i;
    ASSERT_LE(norm(solver.velocity(i) - after.velocities[i]), epsilon * (speed_gain + speed) + 1e-29)
        << name << ", node " << i;
  }
}

}  // namespace crumble
