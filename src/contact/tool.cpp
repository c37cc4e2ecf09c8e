#include "crumble/contact/tool.hpp"

#include <cmath>
#include <limits>

#include "crumble/base/error.hpp"
#include "crumble/base/text.hpp"

namespace crumble {

void check(const Friction& friction) {
  constexpr double kMost = 1e6;
  require_in_range("friction.dynamic", friction.dynamic_coefficient, 0, kMost);
  require_in_range("friction.static", friction.static_coefficient, 0, kMost);
  if (friction.static_coefficient < friction.dynamic_coefficient) {
    throw Error(Code::out_of_range, "friction.static " + to_text(friction.static_coefficient) +
                                        " must not be below friction.dynamic " + to_text(friction.dynamic_coefficient));
  }
}

void check(const Tool& tool) {
  if (!tool.shape) throw Error(Code::empty, "tool.shape is empty");
  if (!is_valid(tool.offset)) throw Error(Code::bad_pose, "tool.offset is not a pose");
  check(tool.friction);
}

void check(const Wall& wall) {
  require_finite("wall.offset", wall.plane.offset);
  require_finite("wall.normal", norm(wall.plane.normal));
  if (std::abs(norm(wall.plane.normal) - 1) > 1e-9) {
    throw Error(Code::out_of_range,
                "wall.normal must be a unit vector, has length " + to_text(norm(wall.plane.normal)));
  }
  check(wall.friction);
}

}  // namespace crumble
