// How far a tool reaches and travels.
#pragma once

#include "crumble/base/vec_array.hpp"
#include "crumble/geometry/pose.hpp"
#include "crumble/geometry/solid.hpp"

namespace crumble {

/// Holds everything that is inside the tool, also by a rounding error.
struct Box {
  Vec3 low, high;
};
Box box_of(const SolidModel& tool, const Frame& frame) noexcept;

/// A bound of the way of the point that goes farthest, metres; exact where it is a corner.
double greatest_travel(const SolidModel& tool, const Frame& from, const Frame& to) noexcept;

}  // namespace crumble
