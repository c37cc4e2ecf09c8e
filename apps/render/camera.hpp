// A perspective camera. Pictures enter no state hash, so Eigen's products are allowed in this folder.
#pragma once

#include <Eigen/Core>

#include "crumble/base/vec.hpp"

namespace crumble::render {

using Mat4 = Eigen::Matrix4f;

struct Camera {
  Vec3 eye = {0.03, 0.05, 0.1};  // metres
  Vec3 target = Vec3::Zero();    // metres
  Vec3 up = {0, 1, 0};           // any length, not along the view
  double vertical_fov = 0.5;     // radians, whole angle
};

/// Throws Error: invalid_value or out_of_range, naming the field; eye on target; up along the view.
void check(const Camera& camera);

/// Looks along `direction` (any length) at the box so that all eight corners are in a picture of `aspect` =
/// width / height, as near as that allows, with a border of `margin` (a share of the picture's half size).
Camera fit_camera(const Vec3& lower, const Vec3& upper, const Vec3& direction, double vertical_fov, double aspect,
                  double margin);

/// World to eye space: x right, y up, looking along -z.
Mat4 view_matrix(const Camera& camera);
/// Eye space to OpenGL's clip space; near and far in metres.
Mat4 perspective_matrix(double vertical_fov, double aspect, double near, double far);
/// Clip space of a parallel light that shines from `to_light` (unit) on a sphere.
Mat4 light_matrix(const Vec3& to_light, const Vec3& center, double radius);

}  // namespace crumble::render
