#include "crumble/device/scripted.hpp"

#include <gtest/gtest.h>

#include <limits>

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

}  // namespace
}  // namespace crumble
