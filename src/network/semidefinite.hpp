// Small symmetric systems, in a fixed order of sums.
#pragma once

#include <array>
#include <cstddef>

namespace crumble {

/// Solves a x = b for a symmetric positive semidefinite `a`, of which only the lower triangle is read, by L D L^T.
/// Directions in which `a` is zero, to 1e-11 of its diagonal, get no part in x. Overwrites `a`; x replaces `b`.
template <std::size_t n>
void solve_semidefinite(std::array<std::array<double, n>, n>& a, std::array<double, n>& b) {
  std::array<double, n> inverse;
  for (std::size_t k = 0; k < n; ++k) {
    const double whole = a[k][k];
    for (std::size_t m = 0; m < k; ++m) a[k][k] -= a[k][m] * a[k][m] * inverse[m];  // a[k][m] holds L D here
    inverse[k] = a[k][k] > 1e-11 * whole ? 1 / a[k][k] : 0;
    for (std::size_t i = k + 1; i < n; ++i) {
      for (std::size_t m = 0; m < k; ++m) a[i][k] -= a[i][m] * a[k][m] * inverse[m];
    }
  }
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t m = 0; m < i; ++m) b[i] -= a[i][m] * inverse[m] * b[m];
  }
  for (std::size_t i = n; i-- > 0;) {
    b[i] *= inverse[i];
    for (std::size_t m = i + 1; m < n; ++m) b[i] -= a[m][i] * inverse[i] * b[m];
  }
}

}  // namespace crumble
