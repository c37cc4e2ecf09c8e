// Vectors: Eigen's types hold them, these functions sum them.
//
// Eigen's reductions (norm, dot, sum, matrix products) may add in another order when they are vectorised, so two
// builds could differ in the last bit. Everything that ends in a state hash sums through the functions below, whose
// order is written out. Element by element Eigen operations (+, -, scalar *) are exact in this sense and are used
// freely.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cmath>

#ifdef __FAST_MATH__
#error "crumble promises bit-identical results: do not compile with -ffast-math"
#endif

namespace crumble {

using Vec3 = Eigen::Vector3d;
using Mat3 = Eigen::Matrix3d;
using Quat = Eigen::Quaterniond;

inline double dot(const Vec3& a, const Vec3& b) {
  return (a.x() * b.x() + a.y() * b.y()) + a.z() * b.z();
}
inline double squared_norm(const Vec3& a) {
  return dot(a, a);
}
inline double norm(const Vec3& a) {
  return std::sqrt(dot(a, a));
}
inline Vec3 cross(const Vec3& a, const Vec3& b) {
  return {a.y() * b.z() - a.z() * b.y(), a.z() * b.x() - a.x() * b.z(), a.x() * b.y() - a.y() * b.x()};
}
/// a / |a|; a must not be zero.
inline Vec3 normalized(const Vec3& a) {
  return a / norm(a);
}
/// Six times the signed volume of the tetrahedron a b c d (positive when d sees a b c counter-clockwise).
inline double orient(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  return dot(cross(b - a, c - a), d - a);
}
inline bool is_finite(const Vec3& a) {
  return std::isfinite(a.x()) && std::isfinite(a.y()) && std::isfinite(a.z());
}

}  // namespace crumble
