// How many bubbles there are, and where they start.
#pragma once

#include <optional>

#include "bubblemesh/cloud.hpp"
#include "bubblemesh/lattice.hpp"
#include "crumble/base/memory.hpp"
#include "crumble/geometry/shape.hpp"

namespace crumble {

/// Lattice points in the body, sorted into those that the surface takes and those that stay inside. A ball belongs to
/// the surface when its centre is within 1.7 / 4.4 of a diameter of it, on either side: the paper's 1.7 mm at 4.4 mm
/// balls, see docs/mesh.md.
struct Carving {
  Vector<Vec3> near_surface;  // nearest to the surface first
  Vector<Vec3> inside;        // lattice order
};
Carving carve(const Shape& shape, const LatticeFrame& frame);

/// Fills the surface, then the inside, with bubbles at rest: relax, take out where they crowd, put in where they gape,
/// until nothing changes. Features must stand in the cloud already. With `exact`, goes on until there are so many
/// surface nodes (features included) or inside nodes; throws Error(out_of_range) if that is too far from the natural
/// number.
void populate_surface(const Shape& shape, double spacing, const Carving& carving, std::optional<std::uint32_t> exact,
                      Cloud& cloud);
void populate_inside(const Shape& shape, double spacing, const Carving& carving, std::optional<std::uint32_t> exact,
                     Cloud& cloud);

}  // namespace crumble
