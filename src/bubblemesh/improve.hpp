// Mends the bad tetrahedra of a mesh.
#pragma once

#include "bubblemesh/cloud.hpp"
#include "crumble/base/memory.hpp"
#include "crumble/geometry/shape.hpp"

namespace crumble {

/// Flips and moves nodes until few tetrahedra are left with a dihedral angle below about 37 degrees or above 143.
void improve(const Shape& shape, double spacing, Cloud& cloud, Vector<Tetrahedron>& tetrahedra);

}  // namespace crumble
