#include "crumble/device/poke.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <limits>

#include "device/samples.hpp"

namespace crumble {
namespace {

const PokeOptions kTwo = {.start = {{0.01, 0.05, -0.02}, axis_angle({0, 0, 1}, 0.3)},
                          .direction = {3, -4, 0},
                          .depth = 0.012,
                          .in = 0.4,
                          .hold = 0.2,
                          .out = 0.6,
                          .rest = 0.3,
                          .count = 2};

double depth_of(const DeviceSample& sample) {
  const Vec3 moved = sample.pose.position - kTwo.start.position;
  EXPECT_NEAR(norm(moved - dot(moved, Vec3(0.6, -0.8, 0)) * Vec3(0.6, -0.8, 0)), 0, 1e-16);
  return dot(moved, Vec3(0.6, -0.8, 0));
}

double speed_of(const DeviceSample& sample) {
  return dot(sample.linear_velocity, Vec3(0.6, -0.8, 0));
}

TEST(Poke, GoesInHoldsComesOutAndRests) {
  const auto device = open_poke(kTwo, 1e-3);
  EXPECT_EQ(device->info().kind, DeviceKind::poke);
  EXPECT_TRUE(device->info().step_locked);
  EXPECT_EQ(device->info().rate, 1000);
  DeviceSample sample;
  for (std::uint64_t k = 0; k <= 2700; ++k) {  // 2 pokes of 1.2 s, 0.3 s between
    ASSERT_EQ(device->read(sample), ReadStatus::ok) << k;
    EXPECT_EQ(sample.sequence, k);
    EXPECT_EQ(sample.time, 1e-3 * static_cast<double>(k));
    EXPECT_NEAR(sample.pose.orientation.z(), std::sin(0.15), 1e-15);
    EXPECT_EQ(sample.angular_velocity, Vec3(0, 0, 0));
    const std::uint64_t ms = k % 1500;
    const double depth = depth_of(sample), speed = speed_of(sample);
    if (ms == 0 || ms > 1200) {
      EXPECT_NEAR(depth, 0, 1e-16) << k;
      EXPECT_NEAR(speed, 0, 1e-12) << k;
    }
    if (ms >= 400 && ms <= 600) {
      EXPECT_NEAR(depth, 0.012, 1e-16) << k;
      EXPECT_NEAR(speed, 0, 1e-12) << k;
    }
    if (ms == 200 || ms == 900) {  // the peaks
      EXPECT_NEAR(depth, 0.006, 1e-16) << k;
      EXPECT_NEAR(speed, 1.875 * 0.012 / (ms == 200 ? 0.4 : -0.6), 1e-15);
    }
    EXPECT_LE(speed, 1.875 * 0.012 / 0.4 + 1e-15) << k;
    EXPECT_GE(speed, -1.875 * 0.012 / 0.6 - 1e-15) << k;
  }
  for (int k = 0; k < 5000; ++k) {  // and no third poke
    ASSERT_EQ(device->read(sample), ReadStatus::finished);
    EXPECT_EQ(sample.flags, sample_flag::kFinished);
    EXPECT_EQ(sample.pose.position, kTwo.start.position);
    EXPECT_EQ(sample.linear_velocity, Vec3(0, 0, 0));
  }
}

TEST(Poke, ItsVelocityIsThatOfItsPositions) {
  const auto samples = read_some(*open_poke(kTwo, 1e-4), 27000);
  double worst = 0;
  for (std::size_t k = 1; k + 1 < samples.size(); ++k) {
    worst = std::max(worst, norm(differenced_velocity(&samples[k]) - samples[k].linear_velocity));
  }
  EXPECT_LT(worst, 1e-6);  // h^2 / 6 of the largest jerk, 60 d / T^3 = 11 m/s^3, is 2e-8; that jumps where a move ends
}

// Least jerk: the integral of its square over one move is 720 d^2 / T^5, and no other move reaches that.
TEST(Poke, SpendsTheLeastJerk) {
  constexpr double kStep = 1e-3, d = 0.012, T = 0.4;
  const auto samples = read_some(*open_poke(kTwo, kStep), 401);
  double spent = 0;
  for (std::size_t k = 0; k + 3 < samples.size(); ++k) {
    const double jerk = (depth_of(samples[k + 3]) - 3 * depth_of(samples[k + 2]) + 3 * depth_of(samples[k + 1]) -
                         depth_of(samples[k])) /
                        (kStep * kStep * kStep);
    spent += jerk * jerk * kStep;
  }
  EXPECT_NEAR(spent / (720 * d * d / (T * T * T * T * T)), 1, 0.03);  // the ends of the integral are cut off
}

TEST(Poke, HasTheSameBitsTwice) {
  const auto a = open_poke(kTwo, 0.0029), b = open_poke(kTwo, 0.0029);
  DeviceSample x, y;
  for (int k = 0; k < 2000; ++k) {
    ASSERT_EQ(a->read(x), b->read(y));
    b->write({1, 2, 3}, {4, 5, 6});
    ASSERT_EQ(bits(x), bits(y)) << k;
  }
}

TEST(Poke, RefusesBadOptionsByName) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const auto expect = [](const std::function<void(PokeOptions&)>& change, Code code, const std::string& text) {
    PokeOptions options = kTwo;
    change(options);
    const Error error = error_of([&] { open_poke(options, 1e-3); });
    EXPECT_EQ(error.code(), code) << error.what() << ", not " << text;
    EXPECT_TRUE(mentions(error, text)) << error.what() << ", not " << text;
  };
  const auto expect_time = [&](double PokeOptions::*field, const std::string& name, bool may_be_zero) {
    expect([&](auto& o) { o.*field = nan; }, Code::invalid_value, name);
    expect([&](auto& o) { o.*field = -0.5; }, Code::out_of_range, name + " must");
    PokeOptions options = kTwo;
    options.*field = 0;
    EXPECT_EQ(error_of([&] { open_poke(options, 1e-3); }).code(), may_be_zero ? Code{} : Code::out_of_range) << name;
  };
  expect_time(&PokeOptions::depth, "poke.depth", false);
  expect_time(&PokeOptions::in, "poke.in", false);
  expect_time(&PokeOptions::hold, "poke.hold", true);
  expect_time(&PokeOptions::out, "poke.out", false);
  expect_time(&PokeOptions::rest, "poke.rest", true);
  expect([](auto& o) { o.count = 0; }, Code::out_of_range, "poke.count must lie in [1, 4294967295], is 0");
  expect([](auto& o) { o.direction.setZero(); }, Code::out_of_range, "|poke.direction|");
  expect([&](auto& o) { o.direction.y() = nan; }, Code::invalid_value, "poke.direction.y");
  expect([&](auto& o) { o.start.position.z() = nan; }, Code::bad_pose, "poke.start");
  expect([](auto& o) { o.hold = 1e308, o.rest = 1e308; }, Code::invalid_value, "poke.count *");
  expect([](auto& o) { o.in = 1e-9; }, Code::out_of_range, "poke.depth / poke.in must lie in [0, 1e+06]");
  expect([](auto& o) { o.out = 1e-9; }, Code::out_of_range, "poke.depth / poke.out");
  EXPECT_EQ(error_of([] { open_poke(kTwo, 0); }).code(), Code::out_of_range);
}

}  // namespace
}  // namespace crumble
