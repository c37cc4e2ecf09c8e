// exp, expm1, sin and cos of our own: libm's differ between systems in the last bit, and a last bit at set-up
// becomes another crack a thousand steps later. Used at set-up only; no step calls them.
#pragma once

namespace crumble {

/// e^x, relative error below 3e-16; 0 below the smallest normal number, +inf above the greatest.
double exp_exact(double x);
/// e^x - 1 without cancellation near 0, relative error below 1e-15.
double expm1_exact(double x);
/// sin and cos for |x| <= 1e4, absolute error below 3e-16.
double sin_exact(double x);
double cos_exact(double x);

inline constexpr double kPi = 3.14159265358979323846;

}  // namespace crumble
