#include "crumble/device/workspace.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "device/samples.hpp"

namespace crumble {
namespace {

TEST(Workspace, MapsByHand) {
  // A quarter turn about z, doubled, then moved: x -> (0, 2, 0) + offset.
  const Workspace map({.pose = {{10, 20, 30}, axis_angle({0, 0, 1}, 1.57079632679489661923)}, .scale = 2});
  DeviceSample device;
  device.pose.position = {1, 0, 3};
  device.linear_velocity = {0, 1, 0};
  device.angular_velocity = {1, 0, 0};
  device.buttons = 5, device.sequence = 7, device.flags = 1, device.time = 0.25;
  const DeviceSample scene = map.to_scene(device);
  EXPECT_LT(norm(scene.pose.position - Vec3(10, 22, 36)), 1e-14);
  EXPECT_LT(norm(scene.linear_velocity - Vec3(-2, 0, 0)), 1e-15);
  EXPECT_LT(norm(scene.angular_velocity - Vec3(0, 1, 0)), 1e-15);
  EXPECT_NEAR(scene.pose.orientation.z(), 0.70710678118654752, 1e-15);
  EXPECT_EQ(scene.buttons, 5u);
  EXPECT_EQ(scene.sequence, 7u);
  EXPECT_EQ(scene.flags, 1u);
  EXPECT_EQ(scene.time, 0.25);
  EXPECT_LT(norm(map.force_to_device({0, 3, 1}) - Vec3(6, 0, 2)), 1e-14);
  EXPECT_LT(norm(map.torque_to_device({0, 3, 1}) - Vec3(3, 0, 1)), 1e-14);
}

// A device that is turned against the scene can still hold its tool along the scene's axes.
TEST(Workspace, MountTurnsTheToolAndNothingElse) {
  const Quat turn = axis_angle({1, 0, 0}, 0.5), back = axis_angle({1, 0, 0}, -0.5);
  const Workspace plain({.pose = {{1, 2, 3}, turn}, .scale = 0.4});
  const Workspace mounted({.pose = {{1, 2, 3}, turn}, .scale = 0.4, .mount = back});
  DeviceSample device;
  device.pose.position = {0.1, 0.2, 0.3};
  device.angular_velocity = {1, 2, 3};
  const DeviceSample a = plain.to_scene(device), b = mounted.to_scene(device);
  EXPECT_NEAR(b.pose.orientation.w(), 1, 1e-15);
  EXPECT_EQ(b.pose.position, a.pose.position);
  EXPECT_EQ(b.angular_velocity, a.angular_velocity);
  // in the stylus' own frame: a quarter turn of the hand about z carries the mount's axis from x to y
  device.pose.orientation = axis_angle({0, 0, 1}, 1.57079632679489661923);
  const Workspace held({.mount = axis_angle({1, 0, 0}, 0.3)});
  const Mat3 r = rotation_matrix(held.to_scene(device.pose).orientation);
  EXPECT_LT(norm(rotate(r, {1, 0, 0}) - Vec3(0, 1, 0)), 1e-15);
  EXPECT_NEAR(rotate(r, {0, 0, 1}).x(), std::sin(0.3), 1e-15);
}

TEST(Workspace, ConservesPowerAtUnitGain) {
  Random random(3);
  for (int i = 0; i < 1000; ++i) {
    WorkspaceOptions options{.pose = {random_vec(random, 1), random_quat(random)}, .scale = random.uniform(0.1, 10)};
    DeviceSample device;
    device.pose = {random_vec(random, 0.1), random_quat(random)};
    device.linear_velocity = random_vec(random, 1);
    device.angular_velocity = random_vec(random, 5);
    const Vec3 force = random_vec(random, 3), torque = random_vec(random, 0.1);

    const Workspace map(options);
    const DeviceSample scene = map.to_scene(device);
    const double linear = dot(force, scene.linear_velocity), angular = dot(torque, scene.angular_velocity);
    EXPECT_NEAR(dot(map.force_to_device(force), device.linear_velocity), linear, 1e-13);
    EXPECT_NEAR(dot(map.torque_to_device(torque), device.angular_velocity), angular, 1e-14);

    options.force_gain = 0.5;
    EXPECT_NEAR(dot(Workspace(options).force_to_device(force), device.linear_velocity), linear / 2, 1e-13);
  }
}

// A spring K in the scene, felt through the map, is g s^2 K.
TEST(Workspace, ScalesFeltStiffness) {
  const Workspace map({.pose = {{1, 2, 3}, axis_angle({0, 1, 0}, 0.7)}, .scale = 3, .force_gain = 0.5});
  const double K = 200;
  const auto felt = [&](const Vec3& device) {
    const Vec3 scene = map.to_scene(Pose{device, Quat::Identity()}).position;
    return map.force_to_device(-K * (scene - Vec3(1, 2, 3)));
  };
  EXPECT_LT(norm(felt({0.01, 0.02, -0.03}) - -0.5 * 9 * K * Vec3(0.01, 0.02, -0.03)), 1e-12);
}

// Any stiffness, one that pulls across its stretch too: what is felt is g s^2 R^T K R, entry by entry, and its force
// and energy are those of the scene's spring.
TEST(Workspace, MapsAStiffnessAsItMapsItsForce) {
  Random random(11);
  for (int i = 0; i < 1000; ++i) {
    const WorkspaceOptions options{.pose = {random_vec(random, 1), random_quat(random)},
                                   .scale = random.uniform(0.1, 10),
                                   .force_gain = random.uniform(0, 2),
                                   .mount = random_quat(random)};
    const Workspace map(options);
    const double g = options.force_gain, s = options.scale;
    Mat3 K;
    for (int row = 0; row < 3; ++row) K.row(row) = random_vec(random, 1000).transpose();
    const Mat3 felt = map.stiffness_to_device(K);

    Vec3 axis[3];  // of the device, in the scene
    for (int a = 0; a < 3; ++a) axis[a] = options.pose.orientation * Vec3(Vec3::Unit(a));
    const double bound = 1e-12 * (1 + g * s * s * 1000);
    for (int a = 0; a < 3; ++a) {
      for (int b = 0; b < 3; ++b) {
        double sum = 0;
        for (int row = 0; row < 3; ++row)
          for (int column = 0; column < 3; ++column) sum += axis[a][row] * K(row, column) * axis[b][column];
        ASSERT_NEAR(felt(a, b), g * s * s * sum, bound) << a << b;
      }
    }

    const Vec3 from = random_vec(random, 0.1), way = random_vec(random, 0.1);
    const Vec3 stretch =
        map.to_scene(Pose{from + way, Quat::Identity()}).position - map.to_scene(Pose{from, Quat::Identity()}).position;
    const Vec3 force = rotate(K, stretch);  // rotate() is the product
    ASSERT_NEAR(norm(map.force_to_device(force) - rotate(felt, way)), 0, bound);
    ASSERT_NEAR(dot(way, rotate(felt, way)), g * dot(stretch, force), bound);
  }
}

TEST(Workspace, VelocityIsTheDerivativeOfPosition) {
  const Workspace map({.pose = {{1, 2, 3}, axis_angle({0.6, 0, 0.8}, 2)}, .scale = 0.4});
  DeviceSample device;
  device.pose.position = {0.01, 0.02, 0.03};
  device.linear_velocity = {0.3, -0.1, 0.2};
  const double h = 1e-4;
  Pose later = device.pose;
  later.position += h * device.linear_velocity;
  const Vec3 step = map.to_scene(later).position - map.to_scene(device.pose).position;
  EXPECT_LT(norm(step / h - map.to_scene(device).linear_velocity), 1e-10);
}

TEST(Workspace, RefusesBadOptionsByName) {
  const double nan = std::numeric_limits<double>::quiet_NaN(), inf = std::numeric_limits<double>::infinity();
  const auto expect = [](const WorkspaceOptions& options, Code code, const std::string& field) {
    const Error error = error_of([&] { Workspace{options}; });
    EXPECT_EQ(error.code(), code) << error.what();
    EXPECT_TRUE(mentions(error, field)) << error.what();
  };
  expect({.scale = 0}, Code::out_of_range, "workspace.scale");
  expect({.scale = -1}, Code::out_of_range, "workspace.scale");
  expect({.scale = nan}, Code::invalid_value, "workspace.scale");
  expect({.force_gain = -0.1}, Code::out_of_range, "workspace.force_gain");
  expect({.force_gain = inf}, Code::invalid_value, "workspace.force_gain");
  expect({.pose = {{0, nan, 0}, Quat::Identity()}}, Code::bad_pose, "workspace.pose");
  expect({.mount = Quat(0, 0, 0, 0)}, Code::bad_pose, "workspace.mount");
  expect({.pose = {Vec3::Zero(), Quat(2, 0, 0, 0)}}, Code::bad_pose, "workspace.pose");
}

}  // namespace
}  // namespace crumble
