// Where a rigid thing is and how it is turned.
#pragma once

#include "crumble/base/vec.hpp"

namespace crumble {

/// Maps local points to the scene: x -> position + R(orientation) x. Metres; unit quaternion.
struct Pose {
  Vec3 position = Vec3::Zero();
  Quat orientation = Quat::Identity();
};

/// Rotation matrix of a unit quaternion, with the sums written out (see base/vec.hpp).
Mat3 rotation_matrix(const Quat& q);
/// Rodrigues: turned by `angle` radians about the unit vector `axis`.
Quat axis_angle(const Vec3& axis, double angle);
/// Hamilton product: first b, then a.
Quat multiply(const Quat& a, const Quat& b);

/// First b, then a: the pose in the scene of what has pose b in the frame of a.
Pose compose(const Pose& a, const Pose& b);

/// R v and R^T v, sums in written order.
inline Vec3 rotate(const Mat3& r, const Vec3& v) {
  return {(r(0, 0) * v.x() + r(0, 1) * v.y()) + r(0, 2) * v.z(), (r(1, 0) * v.x() + r(1, 1) * v.y()) + r(1, 2) * v.z(),
          (r(2, 0) * v.x() + r(2, 1) * v.y()) + r(2, 2) * v.z()};
}
inline Vec3 rotate_back(const Mat3& r, const Vec3& v) {
  return {(r(0, 0) * v.x() + r(1, 0) * v.y()) + r(2, 0) * v.z(), (r(0, 1) * v.x() + r(1, 1) * v.y()) + r(2, 1) * v.z(),
          (r(0, 2) * v.x() + r(1, 2) * v.y()) + r(2, 2) * v.z()};
}

/// A pose with its rotation matrix worked out once.
struct Frame {
  explicit Frame(const Pose& pose) : origin(pose.position), rotation(rotation_matrix(pose.orientation)) {}
  Vec3 to_scene(const Vec3& local) const { return origin + rotate(rotation, local); }
  Vec3 to_local(const Vec3& scene) const { return rotate_back(rotation, scene - origin); }

  Vec3 origin;
  Mat3 rotation;
};

/// Finite position and orientation with | |q| - 1 | <= 1e-3.
bool is_valid(const Pose& pose);
/// The same pose with |q| = 1 to the last bits.
Pose renormalized(const Pose& pose);
/// Between a (s = 0) and b (s = 1): positions on the straight line, orientations by normalised linear blending.
Pose interpolate(const Pose& a, const Pose& b, double s);

}  // namespace crumble
