// Moving nodes so that the tetrahedra around them get better.
#pragma once

#include "bubblemesh/cloud.hpp"
#include "bubblemesh/flips.hpp"
#include "bubblemesh/tet_complex.hpp"
#include "crumble/base/memory.hpp"
#include "crumble/geometry/shape.hpp"

namespace crumble {

/// Searches around a node for a place where the worst tetrahedron at it is better; surface nodes stay on the surface,
/// corners and creases stay. False when there is none.
bool search_place(const Shape& shape, double spacing, Measure measure, const TetComplex& tets, std::uint32_t node,
                  Cloud& cloud);

/// Moves every node of `nodes` once towards where the tetrahedra at it are even: inside to their optimal Delaunay
/// place, on the surface to the centroid of its faces. A move that makes them worse on the whole is not made.
void even_out(const Shape& shape, const TetComplex& tets, const Vector<std::uint32_t>& nodes, Cloud& cloud);

}  // namespace crumble
