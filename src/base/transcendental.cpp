#include "crumble/base/transcendental.hpp"

#include <cmath>
#include <limits>

// Plain argument reduction and Taylor series, long enough for the last bit to be right nearly always. Only + - * /
// and exact scaling by powers of two: the same bits on every processor that has IEEE 754 doubles.

namespace crumble {
namespace {

constexpr double kLn2High = 0x1.62e42fefa0000p-1;  // trailing zeros: n * kLn2High is exact for |n| < 2^17
constexpr double kLn2Low = 0x1.cf79abc9e3b3ap-40;
constexpr double kHalfPiHigh = 0x1.921fb54400000p+0;
constexpr double kHalfPiMid = 0x1.0b4611a600000p-34;
constexpr double kHalfPiLow = 0x1.3198a2e037073p-69;

// e^r - 1 for |r| <= ln2 / 2
double expm1_reduced(double r) {
  double sum = 0;
  for (int n = 18; n >= 2; --n) sum = (sum + 1) * r / n;
  return r + r * sum;
}

double sin_series(double r) {
  const double r2 = r * r;
  double sum = 0;
  for (int n = 20; n >= 2; n -= 2) sum = -(1 + sum) * r2 / (n * (n + 1));
  return r + r * sum;
}

double cos_series(double r) {
  const double r2 = r * r;
  double sum = 0;
  for (int n = 20; n >= 4; n -= 2) sum = -(1 + sum) * r2 / (n * (n - 1));
  return 1 - 0.5 * r2 * (1 + sum);
}

// sin(x + quarter_turns * pi/2)
double sin_shifted(double x, int quarter_turns) {
  const double n = std::nearbyint(x / (kPi / 2));
  const double r = ((x - n * kHalfPiHigh) - n * kHalfPiMid) - n * kHalfPiLow;
  const int quadrant = static_cast<int>((static_cast<long long>(n) + quarter_turns) & 3);
  const double value = quadrant % 2 == 0 ? sin_series(r) : cos_series(r);
  return quadrant < 2 ? value : -value;
}

}  // namespace

double exp_exact(double x) {
  if (std::isnan(x)) return x;
  if (x > 709.78) return std::numeric_limits<double>::infinity();
  if (x < -708.39) return 0;
  const double n = std::nearbyint(x / 0.6931471805599453);
  const double r = (x - n * kLn2High) - n * kLn2Low;
  return std::ldexp(1 + expm1_reduced(r), static_cast<int>(n));
}

double expm1_exact(double x) {
  if (std::abs(x) < 0.34) return expm1_reduced(x);
  return exp_exact(x) - 1;
}

double sin_exact(double x) {
  return sin_shifted(x, 0);
}
double cos_exact(double x) {
  return sin_shifted(x, 1);
}

}  // namespace crumble
