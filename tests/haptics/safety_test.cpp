// The safety stages one by one, and all of them under a million ticks of nonsense.
#include "crumble/haptics/safety.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "crumble/base/random.hpp"

namespace crumble {
namespace {

constexpr double kTick = 1e-3;

DeviceInfo touch() {
  DeviceInfo info;
  info.max_force = 3.3, info.continuous_force = 0.88;
  info.workspace_low = {-0.08, -0.06, -0.035}, info.workspace_high = {0.08, 0.06, 0.035};
  return info;
}

/// Wants the same again and again, sends what comes out.
struct Stage {
  explicit Stage(SafetyOptions options = {.ramp_time = 0}, DeviceInfo info = touch())
      : guard(options, info, kTick, 2 * kTick) {
    base.let_in = true;
  }
  Vec3 tick(const Vec3& wanted) {
    ForceGuard::Order order = base;
    order.force = wanted;
    fault = guard.pass(order, counters);
    guard.sent(order.force, order.torque);
    return order.force;
  }
  Vec3 settle(const Vec3& wanted) {
    Vec3 force = Vec3::Zero();
    for (int k = 0; k < 100; ++k) force = tick(wanted);
    return force;
  }

  ForceGuard guard;
  ForceGuard::Order base;
  SafetyCounters counters;
  Fault fault = Fault::none;
};

TEST(ForceGuard, GrowsNoFasterThanTheSlewAndFallsAtOnce) {
  Stage stage;
  double size = 0;
  for (int k = 1; k <= 10; ++k) {
    size = norm(stage.tick({1.2, 1.6, 0}));
    EXPECT_NEAR(size, std::min(2.0, 0.3 * k), 1e-12);
  }
  EXPECT_EQ(stage.counters.slewed, 6u);
  EXPECT_EQ(norm(stage.tick({0.1, 0, 0})), 0.1);
  EXPECT_EQ(norm(stage.tick(Vec3::Zero())), 0);
}

TEST(ForceGuard, ClampsByNormAndKeepsTheDirection) {
  Stage stage;
  const Vec3 out = stage.settle({6, 8, 0});
  EXPECT_NEAR(norm(out), 3, 1e-12);
  EXPECT_NEAR(out.y() / out.x(), 8.0 / 6, 1e-12);
  EXPECT_EQ(stage.counters.clamped, 100u);
  Stage weak({.ramp_time = 0}, [] {
    DeviceInfo info = touch();
    info.max_force = 1.1;
    return info;
  }());
  EXPECT_NEAR(norm(weak.settle({6, 8, 0})), 1.1, 1e-12);
}

TEST(ForceGuard, FadesWithTheAgeOfTheAnswer) {
  Stage stage;
  stage.settle({1, 0, 0});
  for (int ms = 0; ms <= 25; ++ms) {
    stage.base.age = 1e-3 * ms;
    EXPECT_NEAR(stage.tick({1, 0, 0}).x(), ms <= 2 ? 1 : std::max(0.0, (20.0 - ms) / 18), 1e-12) << ms;
  }
  EXPECT_EQ(stage.counters.aged, 23u);
}

TEST(ForceGuard, FadesOutsideTheWorkspace) {
  Stage stage;
  stage.base.position = {0.08, 0, 0};
  EXPECT_NEAR(stage.settle({1, 0, 0}).x(), 1, 1e-12);
  stage.base.position = {0.084, 0, 0};
  EXPECT_NEAR(stage.settle({1, 0, 0}).x(), 0.6, 1e-12);
  stage.base.position = {0.084, -0.068, 0};
  EXPECT_NEAR(stage.settle({1, 0, 0}).x(), 0.2, 1e-12);
  stage.base.position = {0, 0, 0.1};
  EXPECT_EQ(stage.settle({1, 0, 0}).x(), 0);
  EXPECT_EQ(stage.counters.outside, 300u);
}

TEST(ForceGuard, WarmMotorsGetLess) {
  Stage stage;
  stage.settle({3, 0, 0});
  stage.base.heat = 0.75;
  double before = 3;
  for (int k = 0; k < 5000; ++k) {
    const double now = stage.tick({3, 0, 0}).x();
    EXPECT_LE(now, before);
    EXPECT_GE(now, before * (1 - 1.0001e-3));
    before = now;
  }
  EXPECT_NEAR(before, 0.88, 1e-12);
  EXPECT_GT(stage.counters.heated, 4000u);
  stage.base.heat = 0.6;  // between the two: stays
  EXPECT_NEAR(stage.settle({3, 0, 0}).x(), 0.88, 1e-12);
  stage.base.heat = 0.4;
  for (int k = 0; k < 2000; ++k) stage.tick({3, 0, 0});
  EXPECT_NEAR(stage.tick({3, 0, 0}).x(), 3, 1e-12);
}

TEST(ForceGuard, TheRampGoesUpSlowlyAndDownIn20Milliseconds) {
  Stage stage({.ramp_time = 0.5});
  for (int k = 1; k <= 500; ++k) EXPECT_NEAR(stage.tick({1, 0, 0}).x(), std::min(1.0, k / 500.0), 1e-9);
  stage.base.let_in = false;
  for (int k = 1; k <= 20; ++k) EXPECT_NEAR(stage.tick({1, 0, 0}).x(), 1 - k / 20.0, 1e-9);
  stage.base.let_in = true;
  for (int k = 0; k < 600; ++k) stage.tick({1, 0, 0});
  stage.guard.drop();
  EXPECT_NEAR(stage.tick({1, 0, 0}).x(), 1 / 500.0, 1e-12);
}

TEST(ForceGuard, NotANumberIsAFaultAndZero) {
  for (const double bad : {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    Stage stage;
    stage.settle({1, 0, 0});
    EXPECT_EQ(stage.tick({0, bad, 0}), Vec3(0, 0, 0));
    EXPECT_EQ(stage.fault, Fault::not_finite);
    stage.base.torque = {0, 0, bad};
    EXPECT_EQ(stage.tick({1, 0, 0}), Vec3(0, 0, 0));
  }
}

TEST(ForceGuard, NoTorqueForADeviceWithoutMotorsForIt) {
  Stage stage;
  ForceGuard::Order order = stage.base;
  order.force = {1, 0, 0}, order.torque = {1, 2, 3};
  stage.guard.pass(order, stage.counters);
  EXPECT_EQ(order.torque, Vec3(0, 0, 0));
  DeviceInfo six = touch();
  six.max_torque = 0.05;
  Stage turning({.ramp_time = 0}, six);
  turning.base.torque = {0, 0.3, 0.4};
  for (int k = 0; k < 100; ++k) {
    order = turning.base;
    turning.guard.pass(order, turning.counters);
    turning.guard.sent(order.force, order.torque);
  }
  EXPECT_NEAR(norm(order.torque), 0.05, 1e-12);
}

/// A stick's samples go through the guard.
struct Samples {
  explicit Samples(SafetyOptions options = {}, DeviceInfo info = {}) : guard(options, info, kTick) {}
  Fault tick(const Vec3& position, ReadStatus status = ReadStatus::ok) {
    DeviceSample sample;
    sample.pose.position = position;
    return guard.take(status, sample, counters);
  }
  SampleGuard guard;
  SafetyCounters counters;
};

TEST(SampleGuard, HoldsAJumpForOneTick) {
  Samples s;
  EXPECT_EQ(s.tick({0, 0, 0}), Fault::none);
  EXPECT_EQ(s.tick({0.0004, 0, 0}), Fault::none);
  EXPECT_EQ(s.tick({0.006, 0, 0}), Fault::none);
  EXPECT_EQ(s.guard.sample().pose.position.x(), 0.0004);
  EXPECT_NE(s.guard.sample().flags & sample_flag::kHeld, 0u);
  EXPECT_EQ(s.guard.good(), 0u);
  EXPECT_EQ(s.tick({0.0008, 0, 0}), Fault::none);
  EXPECT_EQ(s.guard.sample().flags & sample_flag::kHeld, 0u);
  EXPECT_EQ(s.guard.sample().pose.position.x(), 0.0008);
  EXPECT_EQ(s.counters.held, 1u);
}

TEST(SampleGuard, ASlowDeviceMayMoveFartherBetweenItsSamples) {
  Samples s;
  s.tick({0, 0, 0});
  for (int k = 0; k < 4; ++k) EXPECT_EQ(s.tick(Vec3::Zero(), ReadStatus::no_new_sample), Fault::none);
  EXPECT_EQ(s.tick({0.004, 0, 0}), Fault::none);
  EXPECT_EQ(s.counters.held, 0u);
  EXPECT_EQ(s.tick({0.0081, 0, 0}), Fault::none);  // 4.1 m/s now
  EXPECT_EQ(s.counters.held, 1u);
}

TEST(SampleGuard, MakesOrientationsUnit) {
  Samples s;
  DeviceSample sample;
  sample.pose.orientation = Quat(1.0005, 0, 0, 0);
  EXPECT_EQ(s.guard.take(ReadStatus::ok, sample, s.counters), Fault::none);
  EXPECT_EQ(s.guard.sample().pose.orientation.w(), 1);
}

// Whatever comes in: no NaN out, norm within the cap, slew within its limit, zero from 20 ms on and after a fault.
TEST(Safety, HoldsForAMillionTicksOfNonsense) {
  Random random(20260917);
  SafetyOptions options{.max_force = 2.5, .max_slew = 200, .ramp_time = 0.05};
  DeviceInfo info = touch();
  info.max_torque = 0.1;
  ForceGuard guard(options, info, kTick, 2 * kTick);
  SafetyCounters counters;
  double last = 0, last_ramp = 0, age = 0;
  std::uint64_t zeros = 0, faults = 0;
  const auto nonsense = [&](double size) {
    switch (random.below(400)) {
      case 0:
        return std::numeric_limits<double>::quiet_NaN();
      case 1:
        return std::numeric_limits<double>::infinity();
      case 2:
        return -1e300;
      case 3:
        return 5e-324;
      default:
        return random.uniform(-size, size);
    }
  };
  for (int k = 0; k < 1'000'000; ++k) {
    age = random.below(50) == 0 ? random.uniform(0, 0.05) : random.below(3) ? 0 : age + kTick;
    ForceGuard::Order order;
    for (int axis = 0; axis < 3; ++axis) order.force[axis] = nonsense(4), order.torque[axis] = nonsense(1);
    order.age = age;
    order.position = {random.uniform(-0.1, 0.1), random.uniform(-0.07, 0.07), random.uniform(-0.04, 0.04)};
    order.heat = random.uniform(0, 1);
    order.let_in = random.below(200) != 0;
    const bool sound = is_finite(order.force) && is_finite(order.torque), up = order.let_in;
    const Fault fault = guard.pass(order, counters);
    ASSERT_EQ(fault == Fault::none, sound);
    ASSERT_TRUE(is_finite(order.force) && is_finite(order.torque)) << k;
    const double size = norm(order.force);
    ASSERT_LE(size, 2.5 * (1 + 1e-12));
    ASSERT_LE(size, last + 0.2 + 1e-12);
    ASSERT_LE(norm(order.torque), 0.1 * (1 + 1e-12));
    ASSERT_TRUE(size == 0 || (sound && age < kStopAge));
    ASSERT_TRUE(guard.ramp() >= last_ramp || !up || !sound);
    zeros += size == 0, faults += !sound;
    guard.sent(order.force, order.torque);
    last = size, last_ramp = guard.ramp();
  }
  EXPECT_GT(faults, 10000u);
  EXPECT_LT(zeros, 700000u);  // most is let through
  EXPECT_GT(counters.clamped, 1000u);
  EXPECT_GT(counters.slewed, 1000u);
}

}  // namespace
}  // namespace crumble
