#include "crumble/device/wander.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <set>

#include "crumble/base/hash.hpp"
#include "crumble/base/memory.hpp"
#include "device/samples.hpp"

namespace crumble {
namespace {

constexpr double kTick = 1e-3;
const WanderOptions kPlain = {.start = {{0.01, 0.05, -0.02}, axis_angle({1, 0, 0}, 0.4)},
                              .low = {-0.03, 0, -0.01},
                              .high = {0.01, 0.02, 0.02},
                              .slowest = 0.03,
                              .fastest = 0.15,
                              .max_pause = 0.2,
                              .max_turn = 0.5,
                              .seed = 5};

double tilt_of(const DeviceSample& sample) {
  const Quat turned = multiply(sample.pose.orientation, kPlain.start.orientation.conjugate());
  return 2 * std::atan2(turned.vec().norm(), std::abs(turned.w()));
}

TEST(Wander, StaysInItsBoxAndGoesEverywhereInIt) {
  const auto device = open_wander(kPlain, kTick);
  EXPECT_EQ(device->info().kind, DeviceKind::wander);
  EXPECT_TRUE(device->info().step_locked);
  DeviceSample sample;
  std::set<int> visited;
  double most = 0;
  for (std::uint64_t k = 0; k < 300'000; ++k) {
    ASSERT_EQ(device->read(sample), ReadStatus::ok);
    ASSERT_EQ(sample.sequence, k);
    ASSERT_EQ(sample.time, kTick * static_cast<double>(k));
    const Vec3 move = sample.pose.position - kPlain.start.position;
    if (k == 0) {
      ASSERT_EQ(move, Vec3(0, 0, 0));
    }
    int eighth = 0;
    for (int axis = 0; axis < 3; ++axis) {
      ASSERT_GE(move[axis], kPlain.low[axis] - 1e-16) << k;
      ASSERT_LE(move[axis], kPlain.high[axis] + 1e-16) << k;
      const double share = (move[axis] - kPlain.low[axis]) / (kPlain.high[axis] - kPlain.low[axis]);
      eighth = 4 * eighth + std::min(static_cast<int>(4 * share), 3);
    }
    visited.insert(eighth);
    ASSERT_LE(norm(sample.linear_velocity), 1.875 * kPlain.fastest + 1e-15);
    ASSERT_LE(tilt_of(sample), kPlain.max_turn + 1e-9);
    most = std::max(most, tilt_of(sample));
  }
  EXPECT_EQ(visited.size(), 64u);  // of 4 x 4 x 4 cells
  EXPECT_GT(most, 0.95 * kPlain.max_turn);
}

// What one move is, read off the rests between them.
TEST(Wander, MovesAtSpeedsInItsRangeAndRestsBetween) {
  WanderOptions options = kPlain;
  options.max_turn = 0;
  const auto samples = read_some(*open_wander(options, kTick), 200'000);
  const double diagonal = norm(kPlain.high - kPlain.low);
  Vector<double> speeds;
  double longest_rest = 0;
  for (std::size_t k = 1; k < samples.size();) {
    const std::size_t begin = k;
    while (k < samples.size() && norm(samples[k].linear_velocity) > 0) ++k;
    const std::size_t end = k;
    while (k < samples.size() && norm(samples[k].linear_velocity) == 0) ++k;
    if (k == samples.size()) break;
    const std::size_t rest = k - end;
    longest_rest = std::max(longest_rest, kTick * static_cast<double>(rest));
    if (rest < 3 || begin == 1) continue;  // one move may follow the other at once
    const double distance = norm(samples[end].pose.position - samples[begin - 1].pose.position);
    double peak = 0;
    for (std::size_t i = begin; i < end; ++i) peak = std::max(peak, norm(samples[i].linear_velocity));
    const double seconds = kTick * static_cast<double>(end - begin);
    if (peak > 1.2 * 1.875 * distance / seconds) continue;  // two moves that touch
    EXPECT_GE(distance, diagonal / 8 - 1e-15);
    EXPECT_NEAR(peak / (1.875 * distance / seconds), 1, 2.5 * kTick / seconds) << begin;
    speeds.push_back(distance / seconds);
  }
  ASSERT_GT(speeds.size(), 200u);
  std::sort(speeds.begin(), speeds.end());
  EXPECT_GT(speeds.front(), 0.98 * kPlain.slowest);
  EXPECT_LT(speeds.back(), 1.03 * kPlain.fastest);
  EXPECT_NEAR(speeds[speeds.size() / 2], 0.09, 0.015);
  EXPECT_LT(longest_rest, kPlain.max_pause + 2 * kTick);
  EXPECT_GT(longest_rest, 0.95 * kPlain.max_pause);
}

TEST(Wander, ItsVelocitiesAreThoseOfItsPoses) {
  WanderOptions options = kPlain;
  options.max_turn = 3;
  const auto samples = read_some(*open_wander(options, 1e-4), 100'000);
  double worst = 0, worst_turning = 0;
  for (std::size_t k = 1; k + 1 < samples.size(); ++k) {
    worst = std::max(worst, norm(differenced_velocity(&samples[k]) - samples[k].linear_velocity));
    worst_turning = std::max(worst_turning, norm(differenced_turning(&samples[k]) - samples[k].angular_velocity));
  }
  EXPECT_LT(worst, 1e-5);          // of 0.28 m/s
  EXPECT_LT(worst_turning, 2e-3);  // of 40 rad/s
}

TEST(Wander, SeedsDecide) {
  WanderOptions other = kPlain;
  other.seed = 6;
  const auto first = read_some(*open_wander(kPlain, kTick), 5000), again = read_some(*open_wander(kPlain, kTick), 5000),
             third = read_some(*open_wander(other, kTick), 5000);
  double apart = 0;
  for (std::size_t k = 0; k < 5000; ++k) {
    ASSERT_EQ(bits(first[k]), bits(again[k])) << k;
    apart = std::max(apart, norm(first[k].pose.position - third[k].pose.position));
  }
  EXPECT_GT(apart, 0.01);
}

TEST(Wander, EndsAtRest) {
  for (const double seconds : {0.01, 2.0, 7.3}) {
    WanderOptions options = kPlain;
    options.seconds = seconds;
    const auto device = open_wander(options, kTick);
    const auto on_time = static_cast<std::size_t>(std::floor(seconds / kTick + 1e-6)) + 1;
    DeviceSample sample, last;
    for (std::size_t k = 0; k < on_time; ++k) ASSERT_EQ(device->read(last), ReadStatus::ok) << k;
    for (int k = 0; k < 2000; ++k) {
      ASSERT_EQ(device->read(sample), ReadStatus::finished);
      EXPECT_EQ(sample.flags, sample_flag::kFinished);
      EXPECT_EQ(sample.pose.position, last.pose.position);
      EXPECT_EQ(sample.linear_velocity, Vec3(0, 0, 0));
      EXPECT_EQ(sample.angular_velocity, Vec3(0, 0, 0));
    }
    EXPECT_EQ(last.linear_velocity, Vec3(0, 0, 0));
    EXPECT_EQ(last.pose.position != kPlain.start.position, seconds > 1);
  }
}

// One number for every compiler and optimisation level.
TEST(Wander, BitsAreThoseOfEveryBuild) {
  const auto device = open_wander(kPlain, 0.0029);
  Hash hash;
  for (const DeviceSample& sample : read_some(*device, 2000)) {
    for (const std::uint64_t word : bits(sample)) hash.add(word);
  }
  EXPECT_EQ(hash.value(), 0x7b30b52b671ba53au);
}

TEST(Wander, RefusesBadOptionsByName) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const auto expect = [](const std::function<void(WanderOptions&)>& change, Code code, const std::string& text) {
    WanderOptions options = kPlain;
    change(options);
    const Error error = error_of([&] { open_wander(options, kTick); });
    EXPECT_EQ(error.code(), code) << error.what() << ", not " << text;
    EXPECT_TRUE(mentions(error, text)) << error.what() << ", not " << text;
  };
  expect([](auto& o) { o.low.x() = 0.001; }, Code::out_of_range, "wander.low.x");
  expect([](auto& o) { o.high.y() = -0.001; }, Code::out_of_range, "wander.high.y");
  expect([&](auto& o) { o.high.z() = nan; }, Code::invalid_value, "wander.high.z");
  expect([](auto& o) { o.low.setZero(), o.high.setZero(); }, Code::out_of_range, "|wander.high - wander.low|");
  expect([](auto& o) { o.low.x() = -1e200; }, Code::invalid_value, "|wander.high - wander.low|");
  expect([](auto& o) { o.slowest = 0; }, Code::out_of_range, "wander.slowest");
  expect([&](auto& o) { o.slowest = nan; }, Code::invalid_value, "wander.slowest");
  expect([](auto& o) { o.fastest = 0.02; }, Code::out_of_range, "wander.fastest must lie in [0.03, 6.7");
  expect([](auto& o) { o.fastest = 7; }, Code::out_of_range, "wander.fastest");  // 1/8 of 54 mm in a tick
  expect([](auto& o) { o.fastest = 2e6, o.low.x() = -1e6; }, Code::out_of_range,
         "wander.fastest must lie in [0, 1e+06]");
  expect([](auto& o) { o.max_pause = -1; }, Code::out_of_range, "wander.max_pause");
  expect([](auto& o) { o.max_turn = 3.2; }, Code::out_of_range, "wander.max_turn");
  expect([&](auto& o) { o.max_turn = nan; }, Code::invalid_value, "wander.max_turn");
  expect([](auto& o) { o.seconds = -1; }, Code::out_of_range, "wander.seconds");
  expect([](auto& o) { o.start.orientation.w() = 1.1; }, Code::bad_pose, "wander.start");
  EXPECT_EQ(error_of([&] { open_wander(kPlain, nan); }).code(), Code::invalid_value);
}

}  // namespace
}  // namespace crumble
