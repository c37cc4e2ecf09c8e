#include "crumble/geometry/pose.hpp"

#include <cmath>

#include "crumble/base/transcendental.hpp"

namespace crumble {
namespace {

double squared_length(const Quat& q) {
  return (q.x() * q.x() + q.y() * q.y()) + (q.z() * q.z() + q.w() * q.w());
}

}  // namespace

Mat3 rotation_matrix(const Quat& q) {
  const double x = q.x(), y = q.y(), z = q.z(), w = q.w();
  Mat3 r;
  r << 1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w),  //
      2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w),   //
      2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y);
  return r;
}

Quat axis_angle(const Vec3& axis, double angle) {
  const double s = sin_exact(angle / 2);
  return {cos_exact(angle / 2), s * axis.x(), s * axis.y(), s * axis.z()};
}

Quat multiply(const Quat& a, const Quat& b) {
  return {((a.w() * b.w() - a.x() * b.x()) - a.y() * b.y()) - a.z() * b.z(),
          ((a.w() * b.x() + a.x() * b.w()) + a.y() * b.z()) - a.z() * b.y(),
          ((a.w() * b.y() + a.y() * b.w()) + a.z() * b.x()) - a.x() * b.z(),
          ((a.w() * b.z() + a.z() * b.w()) + a.x() * b.y()) - a.y() * b.x()};
}

Pose compose(const Pose& a, const Pose& b) {
  return {a.position + rotate(rotation_matrix(a.orientation), b.position), multiply(a.orientation, b.orientation)};
}

bool is_valid(const Pose& pose) {
  const double length = std::sqrt(squared_length(pose.orientation));
  return is_finite(pose.position) && std::abs(length - 1) <= 1e-3;
}

Pose renormalized(const Pose& pose) {
  const double length = std::sqrt(squared_length(pose.orientation));
  const Quat& q = pose.orientation;
  return {pose.position, Quat(q.w() / length, q.x() / length, q.y() / length, q.z() / length)};
}

Pose interpolate(const Pose& a, const Pose& b, double s) {
  const Quat &p = a.orientation, &q = b.orientation;
  const double cosine = (p.x() * q.x() + p.y() * q.y()) + (p.z() * q.z() + p.w() * q.w());
  const double t = cosine < 0 ? -s : s;  // the shorter way round
  const double u = 1 - s;
  return renormalized({a.position + s * (b.position - a.position), Quat(u * p.w() + t * q.w(), u * p.x() + t * q.x(),
                                                                        u * p.y() + t * q.y(), u * p.z() + t * q.z())});
}

}  // namespace crumble
