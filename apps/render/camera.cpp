#include "render/camera.hpp"

#include <algorithm>
#include <cmath>

#include "crumble/base/error.hpp"
#include "crumble/base/text.hpp"
#include "crumble/base/transcendental.hpp"

namespace crumble::render {
namespace {

struct Axes {
  Vec3 right, up, forward;
};

Axes axes_of(const Vec3& view, const Vec3& up) {
  const Vec3 forward = normalized(view);
  const Vec3 right = normalized(cross(forward, up));
  return {right, cross(right, forward), forward};
}

Mat4 to_axes(const Axes& axes, const Vec3& origin) {
  Mat4 m = Mat4::Identity();
  const Vec3 rows[3] = {axes.right, axes.up, -axes.forward};
  for (int i = 0; i < 3; ++i) {
    m.block<1, 3>(i, 0) = rows[i].transpose().cast<float>();
    m(i, 3) = static_cast<float>(-dot(rows[i], origin));
  }
  return m;
}

double tangent_of_half(double angle) {
  return sin_exact(angle / 2) / cos_exact(angle / 2);
}

void require_vector(const char* field, const Vec3& v) {
  for (int i = 0; i < 3; ++i) require_finite(field, v[i]);
}

}  // namespace

void check(const Camera& camera) {
  require_vector("camera.eye", camera.eye);
  require_vector("camera.target", camera.target);
  require_vector("camera.up", camera.up);
  require_in_range("camera.vertical_fov", camera.vertical_fov, 0.01, 3);
  const Vec3 view = camera.target - camera.eye;
  require_positive("distance from camera.eye to camera.target", norm(view));
  require_positive("camera.up's part across the view", norm(cross(view, camera.up)) / norm(view));
}

Camera fit_camera(const Vec3& lower, const Vec3& upper, const Vec3& direction, double vertical_fov, double aspect,
                  double margin) {
  require_in_range("aspect", aspect, 0.01, 100);
  require_in_range("margin", margin, 0, 0.9);
  Camera camera;
  camera.target = 0.5 * (lower + upper);
  camera.eye = camera.target - direction;
  camera.vertical_fov = vertical_fov;
  check(camera);
  const Axes axes = axes_of(direction, camera.up);
  const double high = tangent_of_half(vertical_fov) * (1 - margin), wide = high * aspect;
  double distance = 0;
  for (int corner = 0; corner < 8; ++corner) {
    const Vec3 p =
        Vec3((corner & 1 ? upper : lower).x(), (corner & 2 ? upper : lower).y(), (corner & 4 ? upper : lower).z()) -
        camera.target;
    const double needed = std::max(std::abs(dot(p, axes.right)) / wide, std::abs(dot(p, axes.up)) / high);
    distance = std::max(distance, needed - dot(p, axes.forward));
  }
  camera.eye = camera.target - distance * axes.forward;
  return camera;
}

Mat4 view_matrix(const Camera& camera) {
  return to_axes(axes_of(camera.target - camera.eye, camera.up), camera.eye);
}

Mat4 perspective_matrix(double vertical_fov, double aspect, double near, double far) {
  const double scale = 1 / tangent_of_half(vertical_fov);
  Mat4 m = Mat4::Zero();
  m(0, 0) = static_cast<float>(scale / aspect);
  m(1, 1) = static_cast<float>(scale);
  m(2, 2) = static_cast<float>((far + near) / (near - far));
  m(2, 3) = static_cast<float>(2 * far * near / (near - far));
  m(3, 2) = -1;
  return m;
}

Mat4 light_matrix(const Vec3& to_light, const Vec3& center, double radius) {
  const Vec3 up = std::abs(to_light.y()) < 0.99 ? Vec3(0, 1, 0) : Vec3(1, 0, 0);
  Mat4 m = to_axes(axes_of(-to_light, up), center);
  m.topRows<3>() *= static_cast<float>(1 / radius);
  m.row(2) = -m.row(2);  // OpenGL's depth grows away from the light
  return m;
}

}  // namespace crumble::render
