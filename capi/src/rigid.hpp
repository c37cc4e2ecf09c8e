// Poses and wrenches between C and C++.
#pragma once

#include "crumble/crumble.h"
#include "crumble/geometry/pose.hpp"
#include "crumble/sim/step_info.hpp"

namespace crumble::capi {

inline Pose to_pose(const crumble_pose& pose) {
  const double *p = pose.position, *q = pose.orientation;
  return {{p[0], p[1], p[2]}, Quat(q[0], q[1], q[2], q[3])};
}

inline void copy_to(const Vec3& v, double (&out)[3]) {
  for (int axis = 0; axis < 3; ++axis) out[axis] = v[axis];
}
inline Vec3 to_vector(const double (&v)[3]) {
  return {v[0], v[1], v[2]};
}

inline crumble_pose to_c(const Pose& pose) {
  crumble_pose out;
  copy_to(pose.position, out.position);
  const Quat& q = pose.orientation;
  out.orientation[0] = q.w(), out.orientation[1] = q.x(), out.orientation[2] = q.y(), out.orientation[3] = q.z();
  return out;
}

inline crumble_wrench to_c(const Wrench& wrench) {
  crumble_wrench out;
  copy_to(wrench.force, out.force);
  copy_to(wrench.torque, out.torque);
  return out;
}
inline Wrench to_wrench(const crumble_wrench& wrench) {
  return {to_vector(wrench.force), to_vector(wrench.torque)};
}

}  // namespace crumble::capi
