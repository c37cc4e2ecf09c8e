// How far a tool's corners reach and travel.
#pragma once

#include "crumble/base/vec_array.hpp"
#include "crumble/geometry/convex.hpp"
#include "crumble/geometry/pose.hpp"

namespace crumble {

/// The polyhedron's vertices in its own frame, the last repeated until their number is a multiple of four.
VecArray corners_of(const ConvexPolyhedron& shape);

/// Holds everything that is inside the tool, also by a rounding error.
struct Box {
  Vec3 low, high;
};
Box box_of(VecView corners, const Frame& frame) noexcept;

/// Of the corner that goes farthest, metres.
double greatest_travel(VecView corners, const Frame& from, const Frame& to) noexcept;

}  // namespace crumble
