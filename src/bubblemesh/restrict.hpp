// From the Delaunay tetrahedra of all nodes to those that fill the body.
#pragma once

#include "bubblemesh/cloud.hpp"
#include "crumble/base/memory.hpp"
#include "crumble/geometry/shape.hpp"

namespace crumble {

/// Drops what lies outside. Tetrahedra with a node inside the body always stay, flat or slightly inverted ones
/// too: to drop them would leave holes, and improve() mends them.
void restrict_to_shape(const Shape& shape, double spacing, const Cloud& cloud, Vector<Tetrahedron>& tetrahedra);

}  // namespace crumble
