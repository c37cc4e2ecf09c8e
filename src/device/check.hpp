// What the open functions of this module check alike.
#pragma once

#include <string>
#include <string_view>

#include "crumble/base/error.hpp"
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

}  // namespace crumble::device
