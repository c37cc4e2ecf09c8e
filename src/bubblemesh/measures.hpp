// How good one tetrahedron is: 1 for the regular one, 0 for a flat one, negative when inverted.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>

#include "crumble/base/vec.hpp"

namespace crumble {

/// 6 sqrt2 V / l_rms^3 (Parthasarathy, Graichen and Hathaway 1994).
inline double volume_length(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  const double squares = (squared_norm(b - a) + squared_norm(c - a) + squared_norm(d - a)) +
                         (squared_norm(c - b) + squared_norm(d - b) + squared_norm(d - c));
  const double mean = squares / 6;
  return std::sqrt(2.0) * orient(a, b, c, d) / (mean * std::sqrt(mean));
}

/// Least sine of the six dihedral angles; tells small and large angles alike.
inline double least_sine(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  const Vec3 ab = b - a, ac = c - a, ad = d - a, bc = c - b, bd = d - b, cd = d - c;
  const double volume = dot(cross(ab, ac), ad);
  if (volume == 0) return 0;  // a face may be flat as well
  // twice the areas of the faces opposite to a, b, c, d
  const double fa = norm(cross(bc, bd)), fb = norm(cross(ac, ad)), fc = norm(cross(ab, ad)), fd = norm(cross(ab, ac));
  // at edge l between faces f and g: sin = 6 V l / (2F 2G)
  const std::array<double, 6> factors{norm(ab) / (fc * fd), norm(ac) / (fb * fd), norm(ad) / (fb * fc),
                                      norm(bc) / (fa * fd), norm(bd) / (fa * fc), norm(cd) / (fa * fb)};
  return volume * (volume > 0 ? *std::ranges::min_element(factors) : *std::ranges::max_element(factors));
}

}  // namespace crumble
