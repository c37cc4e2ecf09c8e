#include "crumble/geometry/pose.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "crumble/base/random.hpp"

namespace crumble {
namespace {

Pose random_pose(Random& random) {
  const Vec3 axis = normalized({random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)});
  return {{random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)},
          axis_angle(axis, random.uniform(-3, 3))};
}

// Eigen's own rotation code is the oracle.
TEST(Pose, FrameAgreesWithEigen) {
  Random random(1);
  for (int i = 0; i < 1000; ++i) {
    const Pose pose = random_pose(random);
    const Vec3 v(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1));
    const Frame frame(pose);
    EXPECT_LT((frame.to_scene(v) - (pose.position + pose.orientation * v)).norm(), 1e-15);
    EXPECT_LT((frame.to_local(frame.to_scene(v)) - v).norm(), 2e-15);
  }
}

TEST(Pose, ProductsAgreeWithEigen) {
  Random random(2);
  for (int i = 0; i < 1000; ++i) {
    const Quat a = random_pose(random).orientation, b = random_pose(random).orientation;
    EXPECT_LT((multiply(a, b).coeffs() - (a * b).coeffs()).norm(), 1e-15);
  }
}

TEST(Pose, RefusesWhatIsNotAPose) {
  EXPECT_TRUE(is_valid({Vec3::Zero(), Quat(1.0009, 0, 0, 0)}));
  EXPECT_FALSE(is_valid({Vec3::Zero(), Quat(1.002, 0, 0, 0)}));
  EXPECT_FALSE(is_valid({Vec3::Zero(), Quat(0, 0, 0, 0)}));
  EXPECT_FALSE(is_valid({Vec3(0, std::numeric_limits<double>::quiet_NaN(), 0), Quat::Identity()}));
  EXPECT_FALSE(is_valid({Vec3::Zero(), Quat(std::numeric_limits<double>::infinity(), 0, 0, 0)}));
}

TEST(Pose, InterpolationEndsWhereItShouldAndTakesTheShortWay) {
  Random random(3);
  for (int i = 0; i < 100; ++i) {
    const Pose a = random_pose(random), b = random_pose(random);
    Pose negated = b;
    negated.orientation.coeffs() *= -1;  // the same rotation
    for (const double s : {0.0, 0.3, 1.0}) {
      const Mat3 r = rotation_matrix(interpolate(a, b, s).orientation);
      EXPECT_LT((r - rotation_matrix(interpolate(a, negated, s).orientation)).norm(), 1e-14);
    }
    EXPECT_LT((interpolate(a, b, 1).position - b.position).norm(), 1e-15);
    EXPECT_LT((rotation_matrix(interpolate(a, b, 1).orientation) - rotation_matrix(b.orientation)).norm(), 1e-14);
  }
}

}  // namespace
}  // namespace crumble
