// What a simulated hand tells of itself, and what it refuses.
#include <gtest/gtest.h>

#include <functional>
#include <limits>
#include <string>

#include "crumble/base/memory.hpp"
#include "crumble/device/hand.hpp"
#include "device/samples.hpp"

namespace crumble {
namespace {

constexpr double kTick = 1e-3;

// At rest, with no wish to move.
HandOptions quiet() {
  return {.points = {{.time = 0}}};
}

TEST(HandOptions, TellsWhatItIs) {
  HandOptions options = quiet();
  options.device_mass = 0.06, options.max_force = 7, options.max_stiffness = 1000, options.max_damping = 3;
  const DeviceInfo exact = open_hand(options, 5e-4)->info();
  EXPECT_EQ(exact.name, "simulated hand");
  EXPECT_EQ(exact.kind, DeviceKind::hand);
  EXPECT_EQ(exact.rate, 2000);
  EXPECT_TRUE(exact.step_locked);
  EXPECT_FALSE(exact.servo_driven);
  EXPECT_EQ(exact.max_force, 7);
  EXPECT_EQ(exact.max_stiffness, 1000);
  EXPECT_EQ(exact.max_damping, 3);
  EXPECT_EQ(exact.mass, 0.06);
  EXPECT_EQ(exact.position_step, 0);
  EXPECT_EQ(exact.measured, quantity::kPosition | quantity::kOrientation | quantity::kLinearVelocity);
  options.encoder_step = 2e-5;
  const DeviceInfo coarse = open_hand(options, 5e-4)->info();
  EXPECT_EQ(coarse.position_step, 2e-5);
  EXPECT_EQ(coarse.measured, quantity::kPosition | quantity::kOrientation);
}

TEST(HandOptions, TellsAUnitQuaternion) {
  HandOptions options = quiet();
  options.start.orientation = Quat(1.0005 * 0.6, 0, 1.0005 * 0.8, 0);
  DeviceSample sample;
  EXPECT_EQ(open_hand(options, kTick)->read(sample), ReadStatus::ok);
  EXPECT_NEAR(sample.pose.orientation.w(), 0.6, 1e-15);
  EXPECT_NEAR(sample.pose.orientation.y(), 0.8, 1e-15);
}

void refuse(const std::function<void(HandOptions&)>& change, Code code, const std::string& text, double tick = kTick) {
  HandOptions options = quiet();
  change(options);
  const Error error = error_of([&] { open_hand(options, tick); });
  EXPECT_EQ(error.code(), code) << error.what() << ", not " << text;
  EXPECT_TRUE(mentions(error, text)) << error.what() << ", not " << text;
}

TEST(HandOptions, RefusesBadOptionsByName) {
  const double nan = std::numeric_limits<double>::quiet_NaN(), inf = std::numeric_limits<double>::infinity();
  const auto expect = [&](double HandOptions::*field, const std::string& name, bool may_be_zero) {
    for (const double bad : {nan, inf, -inf}) refuse([&](auto& o) { o.*field = bad; }, Code::invalid_value, name);
    refuse([&](auto& o) { o.*field = -1e-9; }, Code::out_of_range, name);
    if (!may_be_zero) return refuse([&](auto& o) { o.*field = 0; }, Code::out_of_range, name);
    HandOptions options = quiet();
    options.*field = 0;
    EXPECT_NO_THROW(open_hand(options, kTick)) << name;
  };
  expect(&HandOptions::mass, "hand.mass", false);
  expect(&HandOptions::stiffness, "hand.stiffness", true);
  expect(&HandOptions::damping, "hand.damping", true);
  expect(&HandOptions::friction, "hand.friction", true);
  expect(&HandOptions::encoder_step, "hand.encoder_step", true);
  expect(&HandOptions::device_mass, "hand.device_mass", false);
  expect(&HandOptions::max_force, "hand.max_force", false);
  expect(&HandOptions::max_stiffness, "hand.max_stiffness", true);
  expect(&HandOptions::max_damping, "hand.max_damping", true);
  refuse([&](auto& o) { o.device_mass = 0.11; }, Code::out_of_range, "hand.device_mass");
  refuse([&](auto& o) { o.delay = HandOptions::kMaxDelay + 1; }, Code::out_of_range, "hand.delay");
  refuse([&](auto& o) { o.start.position.x() = nan; }, Code::bad_pose, "hand.start");
  refuse([&](auto& o) { o.start.orientation.w() = 1.1; }, Code::bad_pose, "hand.start");
  refuse([](auto&) {}, Code::out_of_range, "tick", 0);
  refuse([](auto&) {}, Code::invalid_value, "tick", nan);
}

TEST(HandOptions, RefusesBadPointsByName) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const auto expect = [](const Vector<HandPoint>& points, Code code, const std::string& text) {
    refuse([&](auto& o) { o.points = points; }, code, text);
  };
  expect({}, Code::empty, "hand.points");
  expect({{.time = -1}}, Code::out_of_range, "hand.points[0].time must be at least 0, is -1");
  expect({{.time = nan}}, Code::invalid_value, "hand.points[0].time");
  expect({{.time = 1}, {.time = 1}}, Code::out_of_range, "hand.points[1].time must be above that before, 1, is 1");
  expect({{.time = 0}, {.time = 2}, {.time = 1}}, Code::out_of_range, "hand.points[2].time");
  expect({{.time = 1, .move = {0, nan, 0}}}, Code::invalid_value, "hand.points[0].move.y");
}

// A substep of h holds k h^2 + 2 b h < 4 m; on this side of it the hand stays in bounds, on the other it is refused.
TEST(HandOptions, RefusesWhatItsSubstepsCannotHold) {
  const double h = kTick / 64;
  for (const double side : {0.999, 1.001}) {
    HandOptions options = quiet();
    options.stiffness = side * 2 * options.mass / (h * h), options.damping = side * options.mass / h;
    options.points = {{.time = 0, .move = {0.01, 0, 0}}};
    if (side > 1) {
      refuse([&](auto& o) { o = options; }, Code::out_of_range, "hand.mass must be above 0.1001");
      continue;
    }
    SimulatedHand hand(options, kTick);
    DeviceSample sample;
    for (int k = 0; k < 5000; ++k) {
      ASSERT_EQ(hand.read(sample), k == 0 ? ReadStatus::ok : ReadStatus::finished);
      ASSERT_LT(norm(sample.pose.position), 0.05);
    }
  }
}

}  // namespace
}  // namespace crumble
