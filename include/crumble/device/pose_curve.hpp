// A smooth motion through the rows of a trajectory.
#pragma once

#include <span>

#include "crumble/base/memory.hpp"
#include "crumble/device/trajectory.hpp"

namespace crumble {

/// Where the tool is at one time, and how it moves there.
struct CurvePoint {
  Pose pose;
  Vec3 linear_velocity;   // m/s, derivative of pose.position
  Vec3 angular_velocity;  // rad/s, derivative of pose.orientation
};

/// Position: the shape-preserving cubic (PCHIP) of Fritsch and Carlson (SIAM J. Numer. Anal. 17, 1980) with the slopes
/// of Fritsch and Butland (SIAM J. Sci. Stat. Comput. 5, 1984). Each component passes through every row, has a
/// continuous derivative, and between two rows never leaves the interval that they span. Orientation: normalised linear
/// blending. Only + - * / and sqrt, so that every build gives the same bits. src/device/pose_curve.cpp says why not a
/// C2 spline.
class PoseCurve {
 public:
  /// Throws what validate throws; Error(empty) for fewer than two rows, (out_of_range) for rows faster than 1e6 m/s.
  explicit PoseCurve(const Trajectory& trajectory);

  double first_time() const { return knots_.front().time; }
  double last_time() const { return knots_.back().time; }
  /// The row at or before `time`; 0 before the first.
  std::size_t row_at(double time) const noexcept;
  /// `time` is clamped to [first_time, last_time].
  CurvePoint at(double time) const noexcept;

 private:
  struct Knot {
    double time;
    Pose pose;
    Vec3 slope;  // m/s
  };
  Vector<Knot> knots_;
};

}  // namespace crumble
