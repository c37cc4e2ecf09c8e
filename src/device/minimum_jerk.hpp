// The move of least jerk from 0 to 1 in unit time, at rest at both ends (Flash and Hogan, J. Neurosci. 5, 1985).
#pragma once

namespace crumble::device {

/// 10 s^3 - 15 s^4 + 6 s^5
inline double minimum_jerk(double s) {
  return s * s * s * (10 + s * (6 * s - 15));
}

/// Its derivative, 30 s^2 (1 - s)^2: at most 1.875, half-way.
inline double minimum_jerk_rate(double s) {
  const double u = s * (1 - s);
  return 30 * (u * u);
}

}  // namespace crumble::device
