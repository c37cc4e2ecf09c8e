#include "render/camera.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "crumble/base/error.hpp"

namespace crumble::render {
namespace {

Eigen::Vector4f project(const Camera& camera, double aspect, const Vec3& p) {
  Eigen::Vector4f h;
  h << p.cast<float>(), 1;
  const Eigen::Vector4f clip = perspective_matrix(camera.vertical_fov, aspect, 0.01, 10) * (view_matrix(camera) * h);
  return clip / clip.w();
}

TEST(Camera, ProjectsLikeSimilarTriangles) {
  Camera camera;
  camera.eye = {0, 0, 2};
  camera.vertical_fov = 2 * std::atan(0.5);  // half the height is half the distance
  const Eigen::Vector4f p = project(camera, 2.0, {0.5, 0.25, 1});
  EXPECT_NEAR(p.x(), 0.5 / (0.5 * 2.0 * 1), 1e-6);
  EXPECT_NEAR(p.y(), 0.25 / 0.5, 1e-6);
  EXPECT_NEAR(project(camera, 2.0, {0, 0, 2 - 0.01}).z(), -1, 1e-4);
  EXPECT_NEAR(project(camera, 2.0, {0, 0, 2 - 10}).z(), 1, 1e-5);
}

TEST(Camera, FitTouchesTheBorderAndLosesNoCorner) {
  const Vec3 lower(-0.02, 0, -0.025), upper(0.03, 0.04, 0.01);
  for (const double aspect : {0.6, 1.0, 1.8}) {
    const Camera camera = fit_camera(lower, upper, {-0.4, -0.5, -1}, 0.5, aspect, 0.1);
    double greatest = 0;
    for (int corner = 0; corner < 8; ++corner) {
      const Vec3 p((corner & 1 ? upper : lower).x(), (corner & 2 ? upper : lower).y(),
                   (corner & 4 ? upper : lower).z());
      const Eigen::Vector4f q = project(camera, aspect, p);
      greatest = std::max({greatest, static_cast<double>(std::abs(q.x())), static_cast<double>(std::abs(q.y()))});
    }
    EXPECT_NEAR(greatest, 0.9, 1e-5);
  }
}

TEST(Camera, RefusesWhatCannotBeSeenThrough) {
  Camera camera;
  camera.target = camera.eye;
  EXPECT_THROW(check(camera), Error);
  camera = {};
  camera.up = camera.eye - camera.target;
  EXPECT_THROW(check(camera), Error);
  camera = {};
  camera.vertical_fov = 0;
  EXPECT_THROW(check(camera), Error);
  camera = {};
  camera.eye.x() = std::nan("");
  EXPECT_THROW(check(camera), Error);
}

}  // namespace
}  // namespace crumble::render
