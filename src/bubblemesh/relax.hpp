// Bubbles push and pull each other until neighbours stand at equal distances.
#pragma once

#include "bubblemesh/cloud.hpp"
#include "crumble/geometry/shape.hpp"

namespace crumble {

/// Greatest depth at which inside nodes are moved, and the least that they keep, in units of d.
inline constexpr double kRelaxedDepth = 3.5;
inline constexpr double kLeastDepth = 0.33;

/// Moves the surface nodes along the surface; features hold still, inside nodes are not looked at.
void relax_surface(const Shape& shape, double spacing, int iterations, Cloud& cloud);

/// Moves the inside nodes that are less than kRelaxedDepth d deep; deeper ones are at rest on the lattice already.
void relax_inside(const Shape& shape, double spacing, int iterations, Cloud& cloud);

}  // namespace crumble
