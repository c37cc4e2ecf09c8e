// The one place that knows FCL.
#pragma once

#include "crumble/base/memory.hpp"
#include "crumble/geometry/triangle_mesh.hpp"

namespace crumble {

/// Distance of each point from the triangles, whichever side it lies on, metres; 0 for points that are nearer than
/// about 1e-6 of the mesh's size. `mesh` has no triangle without area and no number that is not finite. At set-up: FCL
/// allocates.
Vector<double> distances_from_mesh(const TriangleMesh& mesh, const Vector<Vec3>& points);

}  // namespace crumble
