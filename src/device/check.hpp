// What the open functions of this module check alike.
#pragma once

#include <limits>
#include <string>
#include <string_view>

#include "crumble/base/error.hpp"
#include "crumble/base/text.hpp"
#include "crumble/geometry/pose.hpp"

namespace crumble::device {

inline void require_pose(std::string_view field, const Pose& pose) {
  if (!is_valid(pose)) {
    throw Error(Code::bad_pose, std::string(field) + " must have a finite position and | |q| - 1 | <= 1e-3");
  }
}

inline void require_vector(const std::string& field, const Vec3& v) {
  require_finite(field + ".x", v.x());
  require_finite(field + ".y", v.y());
  require_finite(field + ".z", v.z());
}

inline void require_not_negative(std::string_view field, double value) {
  require_in_range(field, value, 0, std::numeric_limits<double>::max());
}

/// What PoseCurve takes too; keeps a script's numbers finite.
inline void require_speed(std::string_view field, double value) {
  require_in_range(field, value, 0, 1e6);
}

/// Points of a way are reached one after the other, the first at 0 or later. `list` is the name of `points`.
template <class Points>
void require_times(const std::string& list, const Points& points) {
  if (points.empty()) throw Error(Code::empty, list + " is empty");
  for (std::size_t i = 0; i < points.size(); ++i) {
    const std::string field = list + '[' + std::to_string(i) + "].time";
    require_finite(field, points[i].time);
    const double before = i > 0 ? points[i - 1].time : 0;
    if (i > 0 ? points[i].time <= before : points[i].time < 0) {
      throw Error(Code::out_of_range, field + " must be " + (i > 0 ? "above that before, " : "at least ") +
                                          to_text(before) + ", is " + to_text(points[i].time));
    }
  }
}

/// Whether a script that lasts to `end` is over. A millionth of a tick of slack: whether the tick that ends it still
/// belongs to it is not left to rounding.
inline bool is_over(double time, double end, double tick) {
  return time > end + 1e-6 * tick;
}

}  // namespace crumble::device
