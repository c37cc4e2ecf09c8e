// Whether two triangles run through each other.
#pragma once

#include <array>

#include "crumble/base/vec.hpp"

namespace crumble {

using Corners = std::array<Vec3, 3>;

/// True when the triangles overlap by more than `tolerance` metres in every direction in which two triangles can be
/// told apart; triangles that only touch, or only share a corner or an edge, do not.
bool triangles_overlap(const Corners& a, const Corners& b, double tolerance);

}  // namespace crumble
