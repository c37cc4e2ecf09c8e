// The plainest body: a box of cubes, each cut into six tetrahedra. For tests, examples and first trials; bodies that
// look and break like tofu come from bubblemesh.
#pragma once

#include "crumble/tetmesh/tet_mesh.hpp"

namespace crumble {

/// Box with edge lengths `size`, resting on y = 0, centred in x and z, of cubes with edges as near to `spacing` as fits
/// (at least one along each axis). Throws Error: out_of_range, too_large (more than 10 million nodes).
TetMesh make_lattice_box(const Vec3& size, double spacing);

}  // namespace crumble
