// How often a surface goes round a point: the judge of what is inside.
#pragma once

#include "crumble/geometry/triangle_mesh.hpp"

namespace crumble {

/// Generalised winding number (Jacobson, Kavan, Sorkine-Hornung 2013): the solid angle that the triangles fill as seen
/// from p, over 4 pi. Of a closed mesh a whole number, 1 inside and 0 outside. Visits every triangle.
double winding_number(const TriangleMesh& mesh, const Vec3& p);

}  // namespace crumble
