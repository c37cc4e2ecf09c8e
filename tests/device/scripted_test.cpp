#include "crumble/device/scripted.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "crumble/base/memory.hpp"
#include "device/samples.hpp"

namespace crumble {
namespace {

TEST(Null, StaysWhereItWasPut) {
  const Pose pose{{0.1, 0.2, 0.3}, axis_angle({0, 0, 1}, 1)};
  const auto device = open_null(pose, 0.002);
  EXPECT_EQ(device->info().kind, DeviceKind::null);
  EXPECT_EQ(device->info().rate, 500);
  EXPECT_TRUE(device->info().step_locked);
  DeviceSample sample;
  for (std::uint64_t k = 0; k < 100; ++k) {
    ASSERT_EQ(device->read(sample), ReadStatus::ok);
    device->write({1, 2, 3}, Vec3::Zero());
    EXPECT_EQ(sample.sequence, k);
    EXPECT_EQ(sample.time, 0.002 * static_cast<double>(k));
    EXPECT_EQ(sample.pose.position, pose.position);
    EXPECT_EQ(sample.linear_velocity, Vec3(0, 0, 0));
    EXPECT_NEAR(sample.pose.orientation.z(), std::sin(0.5), 1e-15);
  }
}

// 2 mm/s for 3 mm along (3, -4, 0) / 5, then 0.5 s still: everything is known.
TEST(Press, FollowsTheClosedForm) {
  PressOptions options;
  options.start.position = {0.01, 0.05, -0.02};
  options.direction = {3, -4, 0};
  options.speed = 2e-3;
  options.depth = 3e-3;
  options.hold = 0.5;
  const auto device = open_press(options, 1e-3);
  EXPECT_EQ(device->info().kind, DeviceKind::press);
  DeviceSample sample;
  for (int k = 0; k <= 2000; ++k) {
    ASSERT_EQ(device->read(sample), ReadStatus::ok) << k;
    const double travel = std::min(2e-6 * k, 3e-3), speed = k < 1500 ? 2e-3 : 0;
    EXPECT_NEAR(sample.pose.position.x(), 0.01 + 0.6 * travel, 1e-16) << k;
    EXPECT_NEAR(sample.pose.position.y(), 0.05 - 0.8 * travel, 1e-16) << k;
    EXPECT_EQ(sample.pose.position.z(), -0.02);
    EXPECT_NEAR(sample.linear_velocity.x(), 0.6 * speed, 1e-18) << k;
    EXPECT_NEAR(sample.linear_velocity.y(), -0.8 * speed, 1e-18) << k;
    EXPECT_NEAR(sample.time, 1e-3 * k, 1e-15);
    EXPECT_EQ(sample.flags, 0u);
  }
  for (int k = 0; k < 10; ++k) {
    ASSERT_EQ(device->read(sample), ReadStatus::finished);
    EXPECT_EQ(sample.flags, sample_flag::kFinished);
    EXPECT_NEAR(sample.pose.position.y(), 0.05 - 0.8 * 3e-3, 1e-16);
    EXPECT_EQ(sample.linear_velocity, Vec3(0, 0, 0));
  }
}

TEST(Press, RefusesBadOptionsByName) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const auto open = [](auto change) {
    PressOptions options;
    change(options);
    return error_of([&] { open_press(options, 1e-3); });
  };
  const auto expect = [](const Error& error, Code code, const std::string& field) {
    EXPECT_EQ(error.code(), code) << error.what();
    EXPECT_TRUE(mentions(error, field)) << error.what();
  };
  expect(open([&](auto& o) { o.speed = 0; }), Code::out_of_range, "press.speed");
  expect(open([&](auto& o) { o.speed = -1; }), Code::out_of_range, "press.speed");
  expect(open([&](auto& o) { o.speed = nan; }), Code::invalid_value, "press.speed");
  expect(open([&](auto& o) { o.depth = 0; }), Code::out_of_range, "press.depth");
  expect(open([&](auto& o) { o.hold = -0.1; }), Code::out_of_range, "press.hold");
  expect(open([&](auto& o) { o.hold = nan; }), Code::invalid_value, "press.hold");
  expect(open([&](auto& o) { o.direction.setZero(); }), Code::out_of_range, "press.direction");
  expect(open([&](auto& o) { o.direction.y() = nan; }), Code::invalid_value, "press.direction.y");
  expect(open([&](auto& o) { o.start.position.z() = nan; }), Code::bad_pose, "press.start");
  expect(open([&](auto& o) { o.start.orientation.w() = 1.1; }), Code::bad_pose, "press.start");
  expect(error_of([] { open_press({}, 0); }), Code::out_of_range, "tick");
  expect(error_of([&] { open_null({}, nan); }), Code::invalid_value, "tick");
  expect(error_of([&] { open_null({{nan, 0, 0}, Quat::Identity()}, 1e-3); }), Code::bad_pose, "pose");
}

// Half a second down, half a second still, then back while it turns 2.5 times: everything is known.
TEST(Path, MovesAndTurnsStraightFromPointToPoint) {
  PathOptions options;
  options.start = {{0.01, 0.05, 0}, axis_angle({1, 0, 0}, 0.4)};
  options.points = {
      {.time = 0.5, .move = {0, -0.01, 0}}, {.time = 1, .move = {0, -0.01, 0}}, {.time = 2, .turn = {0, 5 * M_PI, 0}}};
  const auto device = open_path(options, 1e-3);
  EXPECT_EQ(device->info().kind, DeviceKind::path);
  DeviceSample sample;
  for (int k = 0; k <= 2000; ++k) {
    ASSERT_EQ(device->read(sample), ReadStatus::ok) << k;
    const double time = 1e-3 * k, back = std::max(time - 1, 0.0);
    EXPECT_NEAR(sample.pose.position.y(), 0.05 - 0.02 * std::min(time, 0.5) + 0.01 * back, 1e-15) << k;
    EXPECT_EQ(sample.pose.position.x(), 0.01);
    const Quat turned = multiply(axis_angle({0, 1, 0}, 5 * M_PI * back), options.start.orientation);
    EXPECT_NEAR(std::abs(turned.dot(sample.pose.orientation)), 1, 1e-14) << k;
    if (k == 1500) {
      EXPECT_NEAR(sample.angular_velocity.y(), 5 * M_PI, 1e-13);
    }
    if (k == 200) {
      EXPECT_NEAR(sample.linear_velocity.y(), -0.02, 1e-16);
    }
    if (k == 700) {
      EXPECT_EQ(sample.linear_velocity, Vec3(0, 0, 0));
    }
  }
  ASSERT_EQ(device->read(sample), ReadStatus::finished);
  EXPECT_EQ(sample.flags, sample_flag::kFinished);
  EXPECT_EQ(sample.pose.position, options.start.position);
  EXPECT_EQ(sample.angular_velocity, Vec3(0, 0, 0));
}

// About changing axes: the velocity is that of the poses.
TEST(Path, TellsHowFastItTurns) {
  PathOptions options;
  options.points = {{.time = 0.01, .turn = {1e-4, 0, 0}}, {.time = 1, .turn = {1, -2, 0.5}}};
  constexpr double kTick = 1e-5;
  const auto device = open_path(options, kTick);
  DeviceSample before, sample, after;
  ASSERT_EQ(device->read(before), ReadStatus::ok);
  ASSERT_EQ(device->read(sample), ReadStatus::ok);
  for (int k = 0; k < 99000; ++k) {
    ASSERT_EQ(device->read(after), ReadStatus::ok);
    if (k % 1000 == 500) {
      const Quat turned = multiply(after.pose.orientation, before.pose.orientation.conjugate());
      const Vec3 rate = Vec3(turned.x(), turned.y(), turned.z()) * (2 / turned.w() / (2 * kTick));
      EXPECT_NEAR(norm(rate - sample.angular_velocity), 0, 1e-9) << k;
    }
    before = sample, sample = after;
  }
}

TEST(Path, RefusesBadPointsByName) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const auto expect = [](Vector<PathPoint> points, Code code, const std::string& field) {
    const Error error = error_of([&] { open_path({.points = std::move(points)}, 1e-3); });
    EXPECT_EQ(error.code(), code) << error.what();
    EXPECT_TRUE(mentions(error, field)) << error.what();
  };
  expect({}, Code::empty, "path.points");
  expect({{.time = -1}}, Code::out_of_range, "path.points[0].time must be at least 0, is -1");
  expect({{.time = nan}}, Code::invalid_value, "path.points[0].time");
  expect({{.time = 1}, {.time = 1}}, Code::out_of_range, "path.points[1].time must be above that before, 1, is 1");
  expect({{.time = 1, .move = {0, nan, 0}}}, Code::invalid_value, "path.points[0].move.y");
  expect({{.time = 1, .turn = {nan, 0, 0}}}, Code::invalid_value, "path.points[0].turn.x");
  expect({{.time = 1, .turn = {0, 0, 2e4}}}, Code::out_of_range, "path.points[0].turn");
  expect({{.time = 1, .turn = {1e300, 0, 0}}}, Code::invalid_value, "path.points[0].turn");
  EXPECT_EQ(error_of([&] {
              open_path({.start = {{nan, 0, 0}, {}}, .points = {{.time = 1}}}, 1);
            }).code(),
            Code::bad_pose);
  EXPECT_EQ(error_of([] { open_path({.points = {{.time = 1}}}, 0); }).code(), Code::out_of_range);
}

}  // namespace
}  // namespace crumble
