// What restriction may get wrong in bodies that are thin for the spacing, and how it is put right.
#pragma once

#include "bubblemesh/cloud.hpp"
#include "bubblemesh/features.hpp"
#include "crumble/base/memory.hpp"
#include "crumble/geometry/shape.hpp"

namespace crumble {

struct Flaws {
  Vector<std::size_t> broken_creases;  // creases with a piece that is no edge of the boundary; ascending
  Vector<std::uint32_t> exposed;       // inside nodes on the boundary; ascending
};
Flaws find_flaws(const Cloud& cloud, const Vector<CreaseEdge>& crease_edges, const Vector<Tetrahedron>& tetrahedra);

/// Makes inside nodes surface nodes, at the nearest points of the surface.
void bring_to_surface(const Shape& shape, const Vector<std::uint32_t>& nodes, Cloud& cloud);

}  // namespace crumble
