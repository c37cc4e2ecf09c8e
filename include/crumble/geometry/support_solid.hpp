// Convex sets that only their maker knows, as solids.
#pragma once

#include "crumble/geometry/solid.hpp"

namespace crumble {

/// Writes a point of the set that lies farthest along `direction`, a unit vector; metres. Called at set-up and in the
/// step, by several threads at once if the solid is: it must not block or throw, and give the same point whenever it is
/// asked for the same direction. `context` is the host's own and must outlive the solid.
struct SupportFunction {
  void (*support)(void* context, const double direction[3], double point[3]) = nullptr;
  void* context = nullptr;
};

/// A bounded convex set with an inside. `inside` is any point well within it.
/// Distances are those of the nearest surface, within 1e-9 of the set's size: never less than the depth inside, never
/// more than the distance outside. Normals are right within 3e-5 rad. Of a polyhedron whose faces are less than about
/// 5 degrees apart another face than the nearest may be taken when both are almost equally near: give polyhedra as
/// meshes. A point inside costs 200 to 400 calls of the function, one outside hardly ever any. Results have the same
/// bits on two machines only if those of the function and of libccd have.
/// Half the thickness is the radius of the greatest ball about the mean of the set's sampled surface that fits inside.
/// read_solid() refuses what write() wrote: no file holds the function.
/// Throws Error: null, invalid_value (not finite; points that no convex set has), out_of_range (size, coordinates,
/// inside).
Solid make_support_solid(const SupportFunction& support, const Vec3& inside);

}  // namespace crumble
