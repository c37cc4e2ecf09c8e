// The clocks of a replay other than that of the ticks.
#include <gtest/gtest.h>

#include <cmath>

#include "crumble/base/clock.hpp"
#include "crumble/device/pose_curve.hpp"
#include "crumble/device/recorder.hpp"
#include "crumble/device/replay.hpp"
#include "device/samples.hpp"

namespace crumble {
namespace {

constexpr double kTick = 2e-3;

TEST(RealtimeReplay, IsWhereTheMotionIsByNow) {
  const Trajectory motion = random_trajectory(51, 20);
  const PoseCurve curve(motion);
  const double from = motion.rows[2].time + 1e-3;
  const auto device = open_replay(motion, {.from = from, .to = from + 0.06, .clock = ReplayClock::realtime}, kTick);
  EXPECT_FALSE(device->info().step_locked);
  EXPECT_EQ(device->info().rate, 500);
  EXPECT_FALSE(device->info().measured & quantity::kLinearVelocity);
  double earliest = wall_seconds(), latest = 0, last = -1;  // when the motion began
  std::uint64_t sequence = 0, idle = 0;
  DeviceSample sample;
  for (;;) {
    const DeviceSample before = sample;
    const double asked = wall_seconds();
    const ReadStatus status = device->read(sample);
    const double answered = wall_seconds();
    if (status == ReadStatus::finished) break;
    if (status == ReadStatus::no_new_sample) {
      ++idle;
      ASSERT_EQ(bits(sample), bits(before));
      ASSERT_LT(asked - latest - last, kTick / 2);
      continue;
    }
    ASSERT_EQ(status, ReadStatus::ok);
    if (last < 0) {
      ASSERT_EQ(sample.time, 0);
      latest = answered;
    } else {
      ASSERT_GE(sample.time - last, kTick / 2);
      ASSERT_GE(sample.time, asked - latest);
      ASSERT_LE(sample.time, answered - earliest);
    }
    last = sample.time;
    const CurvePoint point = curve.at(from + sample.time);
    EXPECT_EQ(sample.pose.position, point.pose.position);
    EXPECT_EQ(sample.linear_velocity, point.linear_velocity);
    EXPECT_EQ(sample.angular_velocity, point.angular_velocity);
    EXPECT_TRUE(sample.flags & sample_flag::kResampled);
    EXPECT_EQ(sample.buttons, motion.rows[curve.row_at(from + sample.time)].buttons);
    EXPECT_EQ(sample.sequence, sequence++);
  }
  EXPECT_GT(sequence, 2u);
  EXPECT_LE(sequence, 61u);
  EXPECT_GT(idle, 0u);
  EXPECT_GT(sample.time, 0.06);
  for (int k = 0; k < 3; ++k) {  // at once, however little time has gone by
    ASSERT_EQ(device->read(sample), ReadStatus::finished);
    EXPECT_EQ(sample.pose.position, curve.at(from + 0.06).pose.position);
    EXPECT_EQ(sample.linear_velocity, Vec3(0, 0, 0));
    EXPECT_TRUE(sample.flags & sample_flag::kFinished);
  }
}

TEST(RealtimeReplay, GoesRoundInALoop) {
  const Trajectory motion = random_trajectory(52, 20);
  const PoseCurve curve(motion);
  const double from = motion.rows[3].time, length = 0.02;
  const auto device = open_replay(
      motion, {.from = from, .to = from + length, .end = EndPolicy::loop, .clock = ReplayClock::realtime}, 1e-3);
  DeviceSample sample;
  do {
    if (device->read(sample) != ReadStatus::ok) continue;
    const double lap = std::fmod(sample.time, length);
    EXPECT_LT(norm(sample.pose.position - curve.at(from + lap).pose.position), 1e-12);
  } while (sample.time < 3.2 * length);
}

TEST(FastReplay, GivesEachRowAsItIs) {
  const Trajectory motion = random_trajectory(53, 40);
  const double from = motion.rows[4].time, to = motion.rows[35].time + 1e-4;
  const auto device = open_replay(motion, {.from = from, .to = to, .clock = ReplayClock::fast}, kTick);
  EXPECT_FALSE(device->info().step_locked);
  EXPECT_TRUE(device->info().measured & quantity::kLinearVelocity);
  DeviceSample sample;
  for (std::size_t k = 4; k <= 35; ++k) {
    ASSERT_EQ(device->read(sample), ReadStatus::ok);
    const TrajectoryRow& row = motion.rows[k];
    const DeviceSample expected{row.time - from,      row.pose,    row.linear_velocity,
                                row.angular_velocity, row.buttons, row.flags};
    EXPECT_EQ(bits(sample), bits(expected)) << k;
    EXPECT_EQ(sample.sequence, k - 4);
  }
  for (int k = 0; k < 100; ++k) {
    ASSERT_EQ(device->read(sample), ReadStatus::finished);
    EXPECT_EQ(sample.pose.position, motion.rows[35].pose.position);
    EXPECT_EQ(sample.time, motion.rows[35].time - from);
    EXPECT_EQ(sample.linear_velocity, Vec3(0, 0, 0));
    EXPECT_TRUE(sample.flags & sample_flag::kFinished);
  }
}

TEST(FastReplay, DerivesVelocityWhenTheRowsHaveNone) {
  Trajectory motion = random_trajectory(54, 40);
  motion.columns = quantity::kPosition;
  const auto device = open_replay(motion, {.clock = ReplayClock::fast}, kTick);
  EXPECT_EQ(device->info().measured, quantity::kPosition);
  const PoseCurve curve(motion);
  DeviceSample sample;
  for (const TrajectoryRow& row : motion.rows) {
    ASSERT_EQ(device->read(sample), ReadStatus::ok);
    EXPECT_EQ(sample.linear_velocity, curve.at(row.time).linear_velocity);
    EXPECT_EQ(sample.angular_velocity, curve.at(row.time).angular_velocity);
  }
  EXPECT_EQ(device->read(sample), ReadStatus::finished);
}

// A row at the end of the window is the first of the next lap; time goes on, so that a recorder drops nothing.
TEST(FastReplay, GoesRoundInALoop) {
  const Trajectory motion = random_trajectory(55, 10);
  const double from = motion.rows[0].time, length = motion.rows[9].time - from;
  for (const bool whole : {true, false}) {
    ReplayOptions options{.end = EndPolicy::loop, .clock = ReplayClock::fast};
    if (!whole) options.to = motion.rows[9].time - 1e-4;
    const double lap = whole ? length : *options.to - from;
    Recorder recorder(open_replay(motion, options, kTick), 1000);
    DeviceSample sample;
    for (std::size_t k = 0; k < 90; ++k) {
      ASSERT_EQ(recorder.read(sample), ReadStatus::ok);
      const TrajectoryRow& row = motion.rows[k % 9];
      EXPECT_EQ(sample.pose.position, row.pose.position);
      EXPECT_NEAR(sample.time, (row.time - from) + static_cast<double>(k / 9) * lap, 1e-12);
    }
    EXPECT_EQ(recorder.dropped(), 0u);
  }
}

TEST(ReplayClock, RefusesWhatIsNoneAndAWindowWithoutRows) {
  const Trajectory motion = random_trajectory(56, 10);
  const double first = motion.rows[0].time, second = motion.rows[1].time;
  const auto open = [&](double from, double to, EndPolicy end) {
    return error_of([&] { open_replay(motion, {from, to, end, ReplayClock::fast}, kTick); });
  };
  const Error empty = open(first + 1e-3, second - 1e-3, EndPolicy::hold);
  EXPECT_EQ(empty.code(), Code::empty);
  EXPECT_TRUE(mentions(empty, "replay.from, replay.to: no row")) << empty.what();
  EXPECT_EQ(open(first + 1e-3, second, EndPolicy::hold).code(), Code{});
  EXPECT_EQ(open(first + 1e-3, second, EndPolicy::loop).code(), Code::empty);
  const Error none = error_of([&] { open_replay(motion, {.clock = static_cast<ReplayClock>(3)}, kTick); });
  EXPECT_EQ(none.code(), Code::out_of_range);
  EXPECT_TRUE(mentions(none, "replay.clock must lie in [0, 2], is 3")) << none.what();
}

}  // namespace
}  // namespace crumble
