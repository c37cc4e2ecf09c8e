// What restriction may get wrong in bodies that are thin for the spacing, and how it is put right.
#pragma once

#include "bubblemesh/cloud.hpp"
#include "bubblemesh/features.hpp"
#include "crumble/geometry/shape.hpp"

namespace crumble {

struct Flaws {
  std::vector<std::size_t> broken_creases;  // creases with a piece that is no edge of the boundary; ascending
  std::vector<std::uint32_t> exposed;       // inside nodes on the boundary; ascending
};
Flaws find_flaws(const Cloud& cloud, const std::vector<CreaseEdge>& crease_edges,
                 const std::vector<Tetrahedron>& tetrahedra);

/// Makes inside nodes surface nodes, at the nearest points of the surface.
void bring_to_surface(const Shape& shape, const std::vector<std::uint32_t>& nodes, Cloud& cloud);

}  // namespace crumble
