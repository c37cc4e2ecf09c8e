// Turns as vectors: unit axis times radians.
#pragma once

#include <cmath>

#include "crumble/base/transcendental.hpp"
#include "crumble/geometry/pose.hpp"

namespace crumble::device {

inline Quat turned_by(const Vec3& turn) {
  const double angle = norm(turn);
  return angle > 0 ? axis_angle(turn / angle, angle) : Quat::Identity();
}

/// Angular velocity of turned_by(turn) while `turn` changes by `rate` a second.
inline Vec3 turning(const Vec3& turn, const Vec3& rate) {
  const double angle = norm(turn);
  const bool small = angle < 1e-3;  // series: the closed forms lose their digits
  const double a = small ? 0.5 : (1 - cos_exact(angle)) / (angle * angle);
  const double b = small ? 1.0 / 6 : (angle - sin_exact(angle)) / (angle * angle * angle);
  const Vec3 across = cross(turn, rate);
  return rate + a * across + b * cross(turn, across);
}

}  // namespace crumble::device
