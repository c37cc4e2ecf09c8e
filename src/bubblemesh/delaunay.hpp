// Delaunay tetrahedra of a set of points.
#pragma once

#include <span>

#include "bubblemesh/predicates.hpp"
#include "crumble/base/memory.hpp"
#include "crumble/tetmesh/tet_mesh.hpp"

namespace crumble {

/// Maps points onto the integers of predicates.hpp, so that they fill the middle half of their cube.
Vector<GridPoint> quantize(std::span<const Vec3> points);

/// The Delaunay tetrahedra of the points (no two the same, all well inside the cube of the coordinates), of positive
/// volume on the grid. Tetrahedra that the cube's corners would spoil are left out, so the hull is not always convex:
/// far from the points only those are missing whose circumsphere is larger than the points' extent.
Vector<Tetrahedron> delaunay(std::span<const GridPoint> points);

}  // namespace crumble
