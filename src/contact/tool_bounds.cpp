#include "contact/tool_bounds.hpp"

#include <algorithm>

// Four corners at a time, each lane with its own least and greatest. These do not depend on the order in which they
// are sought, so all compilers find the same.

namespace crumble {
namespace {

constexpr std::size_t kLanes = 4;
// Metres. The box is compared in the scene and the planes in the tool's frame: 1e-9 is far above their rounding errors.
constexpr double kMargin = 1e-9;

struct Range {
  double low, high;
};

Range range_along(VecView corners, double x, double y, double z) noexcept {
  double low[kLanes], high[kLanes];
  std::fill_n(low, kLanes, std::numeric_limits<double>::infinity());
  std::fill_n(high, kLanes, -std::numeric_limits<double>::infinity());
  for (std::size_t i = 0; i < corners.size(); i += kLanes) {
    for (std::size_t k = 0; k < kLanes; ++k) {
      const double along = (x * corners.x[i + k] + y * corners.y[i + k]) + z * corners.z[i + k];
      low[k] = along < low[k] ? along : low[k];
      high[k] = along > high[k] ? along : high[k];
    }
  }
  return {*std::min_element(low, low + kLanes), *std::max_element(high, high + kLanes)};
}

}  // namespace

Box box_of(const SolidModel& tool, const Frame& frame) noexcept {
  const double margin = tool.rounding() + kMargin;
  Box box{frame.origin, frame.origin};
  for (int axis = 0; axis < 3; ++axis) {
    const Mat3& r = frame.rotation;
    const Range range = range_along(tool.corners(), r(axis, 0), r(axis, 1), r(axis, 2));
    box.low[axis] += range.low - margin;
    box.high[axis] += range.high + margin;
  }
  return box;
}

// A ball about a corner turns by no more than | to - from | of the rotations, taken by the Frobenius norm.
double greatest_travel(const SolidModel& tool, const Frame& from, const Frame& to) noexcept {
  const VecView corners = tool.corners();
  const Vec3 d = to.origin - from.origin;
  const Mat3 r = to.rotation - from.rotation;
  double greatest[kLanes] = {};
  for (std::size_t i = 0; i < corners.size(); i += kLanes) {
    for (std::size_t k = 0; k < kLanes; ++k) {
      const double x = corners.x[i + k], y = corners.y[i + k], z = corners.z[i + k];
      const double dx = ((r(0, 0) * x + r(0, 1) * y) + r(0, 2) * z) + d.x();
      const double dy = ((r(1, 0) * x + r(1, 1) * y) + r(1, 2) * z) + d.y();
      const double dz = ((r(2, 0) * x + r(2, 1) * y) + r(2, 2) * z) + d.z();
      const double squared = (dx * dx + dy * dy) + dz * dz;
      greatest[k] = squared > greatest[k] ? squared : greatest[k];
    }
  }
  const double of_corners = std::sqrt(*std::max_element(greatest, greatest + kLanes));
  if (tool.rounding() == 0) return of_corners;
  double squares = 0;
  for (int i = 0; i < 9; ++i) squares += r(i / 3, i % 3) * r(i / 3, i % 3);
  return of_corners + tool.rounding() * std::sqrt(squares);
}

}  // namespace crumble
