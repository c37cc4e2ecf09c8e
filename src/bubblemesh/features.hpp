// Corners and creases: the nodes that are placed first and never move.
#pragma once

#include "bubblemesh/cloud.hpp"
#include "crumble/geometry/shape.hpp"

namespace crumble {

/// A node on each corner; each crease cut into equal pieces of about `spacing`. Equal pieces are where bubbles on a
/// line come to rest, so no relaxation is needed. Returns the pieces' ends: edges that the mesh's surface must have.
std::vector<Edge> place_features(const Shape& shape, double spacing, Cloud& cloud);

}  // namespace crumble
