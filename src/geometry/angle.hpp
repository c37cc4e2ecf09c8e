// Angles with the same bits everywhere, at set-up.
#pragma once

#include <cmath>

#include "crumble/base/transcendental.hpp"

namespace crumble {

/// Of the vector (x, y) against the first axis, radians in [-pi, pi], absolute error below 1e-14; 0 for no vector.
/// Three times tan(a/2) = y / (x + |(x, y)|), which leaves at most pi / 8, then the series of atan.
inline double angle_of(double x, double y) {
  double length = std::sqrt(x * x + y * y);
  if (!(length > 0)) return 0;
  if (x < 0 && std::abs(y) <= 1e-150 * length) return y < 0 ? -kPi : kPi;
  // the half angle, by the form that does not cancel
  double t = x >= 0 ? y / (length + x) : (length - x) / y;
  double factor = 2;
  for (int i = 0; i < 2; ++i) {
    t = t / (1 + std::sqrt(1 + t * t));
    factor *= 2;
  }
  const double square = t * t;
  double sum = 0;
  for (int k = 39; k >= 1; k -= 2) sum = 1.0 / k - square * sum;
  return factor * t * sum;
}

}  // namespace crumble
