// Corners and creases: the nodes that are placed first and never move.
#pragma once

#include "bubblemesh/cloud.hpp"
#include "crumble/base/memory.hpp"
#include "crumble/geometry/shape.hpp"

namespace crumble {

/// A piece of a crease: an edge that the mesh's surface must have.
struct CreaseEdge {
  Edge nodes;
  std::size_t crease;  // index into Shape::creases()
};

/// A node on each corner; each crease cut into equal pieces of about `spacing`, and extra_pieces[crease] more. Equal
/// pieces are where bubbles on a line come to rest, so no relaxation is needed.
Vector<CreaseEdge> place_features(const Shape& shape, double spacing, const Vector<int>& extra_pieces, Cloud& cloud);

}  // namespace crumble
