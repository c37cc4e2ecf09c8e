#include "crumble/device/replay.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

#include "crumble/base/hash.hpp"
#include "crumble/base/memory.hpp"
#include "crumble/device/pose_curve.hpp"
#include "crumble/device/scripted.hpp"
#include "device/samples.hpp"

namespace crumble {
namespace {

const std::string kTrajectories = std::string(CRUMBLE_SOURCE_DIR) + "/examples/trajectories/";

Vector<DeviceSample> read_all(Device& device, std::size_t most = 100000) {
  Vector<DeviceSample> samples;
  DeviceSample sample;
  while (samples.size() < most && device.read(sample) == ReadStatus::ok) samples.push_back(sample);
  return samples;
}

/// `n` rows on the ticks of `tick`.
Trajectory on_ticks(std::size_t n, double tick, double first = 0) {
  Trajectory motion = random_trajectory(21, n);
  for (std::size_t k = 0; k < n; ++k) motion.rows[k].time = first + static_cast<double>(k) * tick;
  return motion;
}

TEST(Replay, SampleKIsRowKWhenTheTicksAreTheRows) {
  const Trajectory motion = on_ticks(50, 0.001, 0.25);
  const auto device = open_replay(motion, {}, 0.001);
  EXPECT_EQ(device->info().kind, DeviceKind::replay);
  EXPECT_TRUE(device->info().measured & quantity::kLinearVelocity);
  const auto samples = read_all(*device);
  ASSERT_EQ(samples.size(), 50u);
  for (std::size_t k = 0; k < 50; ++k) {
    const TrajectoryRow& row = motion.rows[k];
    const DeviceSample expected{static_cast<double>(k) * 0.001, row.pose,    row.linear_velocity,
                                row.angular_velocity,           row.buttons, row.flags};
    EXPECT_EQ(bits(samples[k]), bits(expected)) << k;
    EXPECT_EQ(samples[k].sequence, k);
  }
}

TEST(Replay, DerivesVelocityWhenTheRowsHaveNone) {
  Trajectory motion = on_ticks(50, 0.001);
  motion.columns = quantity::kPosition;
  const auto samples = read_all(*open_replay(motion, {}, 0.001));
  ASSERT_EQ(samples.size(), 50u);
  const PoseCurve curve(motion);
  for (std::size_t k = 0; k < 50; ++k) {
    EXPECT_EQ(samples[k].linear_velocity, curve.at(motion.rows[k].time).linear_velocity);
    EXPECT_FALSE(samples[k].flags & sample_flag::kResampled && !(motion.rows[k].flags & sample_flag::kResampled));
  }
}

TEST(Replay, ResamplesAndSaysSo) {
  Trajectory motion = random_trajectory(22, 40);
  for (auto& row : motion.rows) row.flags = 0;
  const auto device = open_replay(motion, {}, 0.001);
  EXPECT_FALSE(device->info().measured & quantity::kLinearVelocity);
  const auto samples = read_all(*device);
  const double first = motion.rows.front().time, last = motion.rows.back().time;
  ASSERT_EQ(samples.size(), static_cast<std::size_t>((last - first) / 0.001) + 1);
  const PoseCurve curve(motion);
  for (const DeviceSample& sample : samples) {
    EXPECT_EQ(sample.flags, sample_flag::kResampled);
    const CurvePoint point = curve.at(first + sample.time);
    EXPECT_EQ(sample.pose.position, point.pose.position);
    EXPECT_EQ(sample.linear_velocity, point.linear_velocity);
    EXPECT_EQ(sample.angular_velocity, point.angular_velocity);
    EXPECT_EQ(sample.buttons, motion.rows[curve.row_at(first + sample.time)].buttons);
  }
}

TEST(Replay, OneRowOffItsTickIsEnoughToResample) {
  Trajectory motion = on_ticks(20, 0.001);
  motion.rows[7].time += 1e-8;  // more than a millionth of a tick
  EXPECT_TRUE(read_all(*open_replay(motion, {}, 0.001))[3].flags & sample_flag::kResampled);
  motion = on_ticks(20, 0.001);
  motion.rows.erase(motion.rows.begin() + 7);  // a missed row
  EXPECT_TRUE(read_all(*open_replay(motion, {}, 0.001))[3].flags & sample_flag::kResampled);
}

TEST(Replay, TwoReplaysHaveTheSameBits) {
  const Trajectory motion = random_trajectory(23, 200);
  for (const EndPolicy end : {EndPolicy::hold, EndPolicy::loop}) {
    const auto a = open_replay(motion, {.end = end}, 0.0029), b = open_replay(motion, {.end = end}, 0.0029);
    DeviceSample x, y;
    for (int k = 0; k < 3000; ++k) {
      ASSERT_EQ(a->read(x), b->read(y));
      b->write({1, 2, 3}, {4, 5, 6});  // open loop: a force changes nothing
      ASSERT_EQ(bits(x), bits(y)) << k;
      ASSERT_EQ(x.sequence, y.sequence);
    }
  }
}

// One number for every compiler and optimisation level: a curve with rotation, at a tick that meets no row.
TEST(Replay, BitsAreThoseOfEveryBuild) {
  const auto device = open_replay(random_trajectory(24, 300), {}, 0.0029);
  Hash hash;
  DeviceSample sample;
  for (int k = 0; k < 2000; ++k) {
    static_cast<void>(device->read(sample));
    for (const std::uint64_t word : bits(sample)) hash.add(word);
  }
  EXPECT_EQ(hash.value(), 0x9bf0a6cec4db779fu);
}

TEST(Replay, HoldsTheEndAndSaysFinished) {
  for (const double tick : {0.001, 0.0007}) {
    const Trajectory motion = on_ticks(11, 0.001);
    const auto device = open_replay(motion, {}, tick);
    const auto samples = read_all(*device);
    EXPECT_EQ(samples.size(), tick == 0.001 ? 11u : 15u);
    DeviceSample sample;
    for (int k = 0; k < 5; ++k) {
      EXPECT_EQ(device->read(sample), ReadStatus::finished);
      EXPECT_TRUE(sample.flags & sample_flag::kFinished);
      EXPECT_EQ(sample.pose.position, motion.rows.back().pose.position);
      EXPECT_EQ(sample.linear_velocity, Vec3(0, 0, 0));
      EXPECT_EQ(sample.angular_velocity, Vec3(0, 0, 0));
    }
  }
}

TEST(Replay, PlaysAWindow) {
  const Trajectory motion = on_ticks(101, 0.01);
  const auto rows = read_all(*open_replay(motion, {.from = 0.2, .to = 0.5}, 0.01));
  ASSERT_EQ(rows.size(), 31u);
  EXPECT_EQ(rows.front().time, 0);
  EXPECT_EQ(rows.front().pose.position, motion.rows[20].pose.position);
  EXPECT_EQ(rows.back().pose.position, motion.rows[50].pose.position);
  EXPECT_FALSE(rows[1].flags & sample_flag::kResampled && !(motion.rows[21].flags & sample_flag::kResampled));

  const PoseCurve curve(motion);
  const auto between = read_all(*open_replay(motion, {.from = 0.203, .to = 0.5}, 0.01));
  ASSERT_EQ(between.size(), 30u);
  EXPECT_EQ(between[3].pose.position, curve.at(0.203 + 3 * 0.01).pose.position);
}

TEST(Replay, LoopsForEver) {
  const Trajectory motion = on_ticks(11, 0.001);
  for (const double tick : {0.001, 0.0004}) {  // on the rows, and between them: a lap of 10 or 25 ticks
    const auto device = open_replay(motion, {.end = EndPolicy::loop}, tick);
    const auto samples = read_all(*device, 1000);
    ASSERT_EQ(samples.size(), 1000u);
    const std::size_t lap = tick == 0.001 ? 10 : 25;
    for (std::size_t k = 0; k + lap < 1000; ++k) {
      EXPECT_LT(norm(samples[k].pose.position - samples[k + lap].pose.position), 1e-12) << tick << ' ' << k;
      EXPECT_EQ(samples[k].time, static_cast<double>(k) * tick);
    }
  }
}

TEST(Replay, RefusesBadOptionsByName) {
  const Trajectory motion = on_ticks(11, 0.001);
  const auto expect = [&](const ReplayOptions& options, double tick, Code code, const std::string& field) {
    const Error error = error_of([&] { open_replay(motion, options, tick); });
    EXPECT_EQ(error.code(), code) << error.what();
    EXPECT_TRUE(mentions(error, field)) << error.what();
  };
  expect({}, 0, Code::out_of_range, "tick");
  expect({.from = -0.001}, 0.001, Code::out_of_range, "replay.from");
  expect({.to = 0.011}, 0.001, Code::out_of_range, "replay.to");
  expect({.from = 0.005, .to = 0.005}, 0.001, Code::out_of_range, "replay.to - replay.from");
  expect({.from = 0.007, .to = 0.005}, 0.001, Code::out_of_range, "replay.to - replay.from");
  expect({.from = std::numeric_limits<double>::quiet_NaN()}, 0.001, Code::invalid_value, "replay.from");
  EXPECT_EQ(error_of([] { open_replay(Trajectory{}, {}, 0.001); }).code(), Code::empty);
}

// The example press is the scripted press.
TEST(Examples, PressFileIsThePress) {
  const auto replay = open_replay(read_trajectory(kTrajectories + "press_1mm_s.ctraj"), {}, 1e-3);
  const auto press = open_press({.speed = 1e-3, .depth = 0.03}, 1e-3);
  const auto a = read_all(*replay), b = read_all(*press);
  ASSERT_EQ(a.size(), 30001u);
  ASSERT_EQ(b.size(), a.size());
  for (std::size_t k = 0; k < a.size(); ++k) {
    EXPECT_LT(norm(a[k].pose.position - b[k].pose.position), 1e-16) << k;
    EXPECT_LT(norm(a[k].linear_velocity - b[k].linear_velocity), k < 30000 ? 1e-16 : 2e-3)
        << k;  // the press has stopped
  }
}

// Numbers from the source's own description: 2743 rows at 100 Hz, 27.42 s, median speed 59 mm/s, greatest 208 mm/s.
TEST(Examples, TouchMotionIsTheRecordedMotion) {
  const Trajectory motion = read_trajectory(kTrajectories + "touch_motion.ctraj");
  EXPECT_EQ(motion.columns, quantity::kPosition);
  EXPECT_EQ(motion.value_of("license"), "new BSD");
  EXPECT_EQ(motion.value_of("source_csv_sha256"), "05de4c01114beae4cb9350fa92c7837eabb22b67c2ca938aed7fab1d6cda6680");
  ASSERT_EQ(motion.rows.size(), 2743u);
  EXPECT_EQ(motion.rows[3].time, 0.030001);
  EXPECT_EQ(motion.rows[3].pose.position, Vec3(0, -0.065510712, -0.088114197));
  EXPECT_EQ(motion.rows.back().time, 27.419999);
  Vec3 low = motion.rows[0].pose.position, high = low;
  Vector<double> moving;  // mm/s, the rests in the inkwell left out
  for (std::size_t i = 1; i < motion.rows.size(); ++i) {
    const auto &a = motion.rows[i - 1], &b = motion.rows[i];
    for (int c = 0; c < 3; ++c) {
      low[c] = std::min(low[c], b.pose.position[c]);
      high[c] = std::max(high[c], b.pose.position[c]);
    }
    const double speed = 1e3 * norm(b.pose.position - a.pose.position) / (b.time - a.time);
    moving.push_back(speed);
  }
  EXPECT_EQ(low, Vec3(-0.121163345, -0.072884148, -0.088239647));
  EXPECT_EQ(high, Vec3(0.092274139, 0.066976974, 0.001216278));
  std::sort(moving.begin(), moving.end());
  EXPECT_NEAR(moving.back(), 208, 2);
  EXPECT_NEAR(moving[moving.size() / 2], 59, 3);
}

// At 1 kHz the hand never leaves the box of its 100 Hz rows, and says that it was resampled.
TEST(Examples, TouchMotionAtOneKilohertz) {
  const Trajectory motion = read_trajectory(kTrajectories + "touch_motion.ctraj");
  const auto samples = read_all(*open_replay(motion, {}, 1e-3));
  ASSERT_EQ(samples.size(), 27420u);
  for (const DeviceSample& sample : samples) {
    EXPECT_TRUE(sample.flags & sample_flag::kResampled);
    EXPECT_GE(sample.pose.position.x(), -0.121163345);
    EXPECT_LE(sample.pose.position.y(), 0.066976974);
    EXPECT_LE(sample.pose.position.z(), 0.001216278);
    EXPECT_LT(norm(sample.linear_velocity), 0.35);
  }
}

}  // namespace
}  // namespace crumble
