// Other people's answers about convex tools: libccd's MPR and FCL's mesh distance.
//
// Both work on a copy in units of the tool's half thickness, since libccd compares lengths with fixed numbers and is
// wrong in metres. They take the tool's pose and a scene point, and turn it with Eigen's own quaternion, so that our
// frames are under test too.
#pragma once

#include <memory>

#include "crumble/geometry/convex.hpp"
#include "crumble/geometry/pose.hpp"

namespace crumble {

/// How MPR moves a point out of a convex body.
struct MprAnswer {
  bool inside = false;
  double depth = 0;               // metres
  Vec3 direction = Vec3::Zero();  // unit: the point goes to point + depth * direction
};

/// MPR looks for the way out where the ray from `center`, any point inside, through `point` leaves the body. It
/// answers the distance from `point` to the last portal, a triangle of the body's corners on the face met there. So
/// its depth is that of the nearest face only if the ray meets this face and the portal covers the point; otherwise
/// it is greater, never less.
MprAnswer mpr_penetration(const ConvexPolyhedron& body, const Pose& pose, const Vec3& point, const Vec3& center);

/// FCL's distance between the tool's triangles, a hollow surface to FCL, and a small sphere.
class FclSurface {
 public:
  explicit FclSurface(const ConvexPolyhedron& body);
  ~FclSurface();
  /// From the surface to `point`, positive on both sides, metres. Only beyond least_distance(): nearer the sphere
  /// touches, and FCL's mesh depth is not usable.
  double distance(const Pose& pose, const Vec3& point) const;
  double least_distance() const;

 private:
  struct Model;
  std::unique_ptr<Model> model_;
};

}  // namespace crumble
