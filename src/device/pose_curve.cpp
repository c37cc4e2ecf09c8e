// Why a shape-preserving cubic and not a C2 spline.
//
// The tool moves next to a body. A C2 spline swings past the rows where the motion starts, stops or turns, so the tool
// would touch, or press deeper, before the hand did, and the body would be cut by motion that nobody made. On the
// recorded motion of examples/trajectories/touch_motion.ctraj (100 Hz) a natural C2 spline leaves the interval between
// neighbouring rows by up to 0.12 mm, and moves a hand that rests; this curve by 0. Taking every other row away and
// predicting it from the rest, the two err alike (rms 0.035, 0.022, 0.022 mm in x, y, z for this curve, 0.036, 0.022,
// 0.023 for the spline), so what is lost is only the continuity of the acceleration at the rows. It is also local: no
// system of equations, and a change of one row changes four intervals.
#include "crumble/device/pose_curve.hpp"

#include <algorithm>
#include <cmath>

#include "crumble/base/error.hpp"
#include "crumble/base/memory.hpp"
#include "crumble/base/text.hpp"

namespace crumble {
namespace {

constexpr double kMaxSpeed = 1e6;  // m/s: faster rows are damaged, or not in metres and seconds

/// Slope at a row between two intervals of lengths h0, h1 and secant slopes d0, d1: a weighted harmonic mean, 0 at a
/// turn. Fritsch and Butland (1984).
double inner_slope(double h0, double h1, double d0, double d1) {
  if (!((d0 > 0 && d1 > 0) || (d0 < 0 && d1 < 0))) return 0;
  const double w0 = 2 * h1 + h0, w1 = h1 + 2 * h0;
  return (w0 + w1) / (w0 / d0 + w1 / d1);
}

/// Slope at the end whose interval is (h0, d0) and whose next one is (h1, d1): the parabola through three rows, limited
/// so that the curve stays monotone. Fritsch and Carlson (1980).
double end_slope(double h0, double h1, double d0, double d1) {
  const double slope = ((2 * h0 + h1) * d0 - h0 * d1) / (h0 + h1);
  if (!(slope * d0 > 0)) return 0;
  if (!(d0 * d1 > 0) && std::abs(slope) > 3 * std::abs(d0)) return 3 * d0;
  return slope;
}

/// One component of the Hermite cubic at fraction s of an interval of length h, as a step from the row p0: a hand that
/// rests stays at rest to the bit.
double hermite(double p0, double p1, double m0, double m1, double h, double s) {
  const double u = 1 - s;
  const double p = p0 + (s * s * (3 - 2 * s) * (p1 - p0) + h * s * u * (u * m0 - s * m1));
  return std::clamp(p, std::min(p0, p1), std::max(p0, p1));  // rounding must not leave the interval either
}

/// Its derivative in time.
double hermite_slope(double p0, double p1, double m0, double m1, double h, double s) {
  const double u = 1 - s;
  return 6 * s * u * ((p1 - p0) / h) + (u * (1 - 3 * s) * m0 + s * (3 * s - 2) * m1);
}

/// Derivative of interpolate(a, b, s).orientation in s / h: with n the unnormalised blend, q = n / |n|, the part of q'
/// along q drops out of the vector part of q' q*, so omega = 2 vec(n' n*) / |n|^2.
Vec3 blend_velocity(const Quat& a, const Quat& b, double h, double s) {
  const double cosine = (a.x() * b.x() + a.y() * b.y()) + (a.z() * b.z() + a.w() * b.w());
  const double sign = cosine < 0 ? -1 : 1, u = 1 - s, v = sign * s;
  const Quat n(u * a.w() + v * b.w(), u * a.x() + v * b.x(), u * a.y() + v * b.y(), u * a.z() + v * b.z());
  const Quat rate(sign * b.w() - a.w(), sign * b.x() - a.x(), sign * b.y() - a.y(), sign * b.z() - a.z());
  const Quat product = multiply(rate, Quat(n.w(), -n.x(), -n.y(), -n.z()));
  const double squared = (n.x() * n.x() + n.y() * n.y()) + (n.z() * n.z() + n.w() * n.w());
  return Vec3(product.x(), product.y(), product.z()) * (2 / (squared * h));
}

}  // namespace

PoseCurve::PoseCurve(const Trajectory& trajectory) {
  validate(trajectory);
  const std::size_t n = trajectory.rows.size();
  if (n < 2) throw Error(Code::empty, "a curve needs two rows at least, the trajectory has one");
  knots_.reserve(n);
  for (const TrajectoryRow& row : trajectory.rows) knots_.push_back({row.time, renormalized(row.pose), Vec3::Zero()});

  const auto length = [&](std::size_t i) { return knots_[i + 1].time - knots_[i].time; };
  Vector<Vec3> secants(n - 1);
  for (std::size_t i = 0; i + 1 < n; ++i) {
    secants[i] = (knots_[i + 1].pose.position - knots_[i].pose.position) / length(i);
    // Also keeps everything below finite. The negation catches NaN.
    if (!(norm(secants[i]) <= kMaxSpeed)) {
      throw Error(Code::out_of_range, "trajectory.rows[" + std::to_string(i + 1) + "]: " + to_text(norm(secants[i])) +
                                          " m/s from the row before, more than " + to_text(kMaxSpeed));
    }
  }
  for (int axis = 0; axis < 3; ++axis) {
    const auto secant = [&](std::size_t i) { return secants[i][axis]; };
    if (n == 2) {
      knots_[0].slope[axis] = knots_[1].slope[axis] = secant(0);
      continue;
    }
    knots_[0].slope[axis] = end_slope(length(0), length(1), secant(0), secant(1));
    knots_[n - 1].slope[axis] = end_slope(length(n - 2), length(n - 3), secant(n - 2), secant(n - 3));
    for (std::size_t i = 1; i + 1 < n; ++i) {
      knots_[i].slope[axis] = inner_slope(length(i - 1), length(i), secant(i - 1), secant(i));
    }
  }
}

std::size_t PoseCurve::row_at(double time) const noexcept {
  const auto after =
      std::upper_bound(knots_.begin(), knots_.end(), time, [](double t, const Knot& knot) { return t < knot.time; });
  return after == knots_.begin() ? 0 : static_cast<std::size_t>(after - knots_.begin()) - 1;
}

CurvePoint PoseCurve::at(double time) const noexcept {
  const std::size_t i = std::min(row_at(time), knots_.size() - 2);
  const Knot &a = knots_[i], &b = knots_[i + 1];
  const double h = b.time - a.time;
  const double s = std::clamp((time - a.time) / h, 0.0, 1.0);
  if (s == 1) return {b.pose, b.slope, blend_velocity(a.pose.orientation, b.pose.orientation, h, 1)};
  CurvePoint out{interpolate(a.pose, b.pose, s), Vec3::Zero(),
                 blend_velocity(a.pose.orientation, b.pose.orientation, h, s)};
  for (int axis = 0; axis < 3; ++axis) {
    const double p0 = a.pose.position[axis], p1 = b.pose.position[axis], m0 = a.slope[axis], m1 = b.slope[axis];
    out.pose.position[axis] = hermite(p0, p1, m0, m1, h, s);
    out.linear_velocity[axis] = hermite_slope(p0, p1, m0, m1, h, s);
  }
  return out;
}

}  // namespace crumble
