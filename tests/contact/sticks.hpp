// The tools of the paper's experiments, and random places for them.
#pragma once

#include <cmath>
#include <string>

#include "crumble/base/memory.hpp"
#include "crumble/base/random.hpp"
#include "crumble/geometry/convex.hpp"
#include "crumble/geometry/pose.hpp"

namespace crumble {

struct Stick {
  std::string name;
  ConvexPolyhedron shape;
  Vec3 size;            // edges of a bar; of a round stick 2 radius, 2 radius, length
  std::uint32_t sides;  // 0 for a bar
};

inline Vector<Stick> paper_sticks() {
  return {{"round_8mm", make_round_stick(0.004, 0.05, 16), {0.008, 0.008, 0.05}, 16},
          {"bar_6x6mm", make_bar({0.006, 0.006, 0.05}), {0.006, 0.006, 0.05}, 0},
          {"bar_3x10mm", make_bar({0.003, 0.01, 0.05}), {0.003, 0.01, 0.05}, 0},
          {"globe_16mm", make_round_stick(0.008, 0.1, 16), {0.016, 0.016, 0.1}, 16}};
}

/// Uniform in the cube [-1, 1]^3.
inline Vec3 random_vector(Random& random) {
  const double x = random.uniform(-1, 1), y = random.uniform(-1, 1), z = random.uniform(-1, 1);
  return {x, y, z};
}

inline Vec3 random_direction(Random& random) {
  while (true) {
    const Vec3 v = random_vector(random);
    if (const double length = norm(v); length > 0.1 && length <= 1) return v / length;
  }
}

/// Any orientation; positions in a cube of edge 0.2 m about the origin.
inline Pose random_pose(Random& random) {
  const Vec3 axis = random_direction(random);
  return {0.1 * random_vector(random), axis_angle(axis, random.uniform(-3.1, 3.1))};
}

}  // namespace crumble
