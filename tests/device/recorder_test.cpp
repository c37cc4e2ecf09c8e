#include "crumble/device/recorder.hpp"

#include <gtest/gtest.h>

#include "crumble/base/memory.hpp"
#include "crumble/device/replay.hpp"
#include "crumble/device/scripted.hpp"
#include "device/samples.hpp"

namespace crumble {
namespace {

/// Hands out the given samples, then says lost.
class Scripted final : public Device {
 public:
  explicit Scripted(Vector<std::pair<ReadStatus, double>> script) : script_(std::move(script)) {
    info_.name = "two\nlines";
  }
  const DeviceInfo& info() const noexcept override { return info_; }
  ReadStatus read(DeviceSample& sample) noexcept override {
    if (next_ == script_.size()) return ReadStatus::lost;
    sample = {};
    sample.time = script_[next_].second;
    return script_[next_++].first;
  }
  void write(const Vec3& force, const Vec3&) noexcept override { written = force; }

  Vec3 written = Vec3::Zero();

 private:
  DeviceInfo info_;
  Vector<std::pair<ReadStatus, double>> script_;
  std::size_t next_ = 0;
};

TEST(Recorder, WhatWasRecordedPlaysBackTheSame) {
  Trajectory motion = random_trajectory(31, 60);
  Recorder recorder(open_replay(motion, {}, 0.001), 10000);
  EXPECT_EQ(recorder.info().kind, DeviceKind::replay);
  Vector<DeviceSample> live;
  DeviceSample sample;
  while (recorder.read(sample) == ReadStatus::ok) {
    live.push_back(sample);
    recorder.write({sample.time, 1, 2}, {3, 4, sample.time});
  }
  EXPECT_EQ(recorder.size(), live.size());
  EXPECT_EQ(recorder.dropped(), 0u);

  const Trajectory kept = parse_trajectory(format_trajectory(recorder.trajectory()), "recording");
  EXPECT_EQ(kept.value_of("units"), "m s N N*m rad");
  EXPECT_EQ(kept.value_of("kind"), "replay");
  const auto again = open_replay(kept, {}, 0.001);
  for (std::size_t k = 0; k < live.size(); ++k) {
    ASSERT_EQ(again->read(sample), ReadStatus::ok);
    EXPECT_EQ(bits(sample), bits(live[k])) << k;
    EXPECT_EQ(kept.rows[k].force, Vec3(live[k].time, 1, 2));
    EXPECT_EQ(kept.rows[k].torque, Vec3(3, 4, live[k].time));
  }
  EXPECT_EQ(again->read(sample), ReadStatus::finished);
}

TEST(Recorder, CountsWhatItCannotKeep) {
  Recorder recorder(open_null({}, 0.001), 10);
  DeviceSample sample;
  for (int k = 0; k < 25; ++k) {
    ASSERT_EQ(recorder.read(sample), ReadStatus::ok);
    recorder.write({static_cast<double>(k), 0, 0}, Vec3::Zero());
  }
  EXPECT_EQ(recorder.size(), 10u);
  EXPECT_EQ(recorder.dropped(), 15u);
  const Trajectory kept = recorder.trajectory();
  EXPECT_EQ(kept.value_of("dropped"), "15");
  EXPECT_EQ(kept.rows.back().force, Vec3(9, 0, 0));  // a dropped sample's force goes to no other row
}

TEST(Recorder, KeepsOnlyNewSamplesInOrder) {
  using enum ReadStatus;
  auto device = std::make_unique<Scripted>(
      Vector<std::pair<ReadStatus, double>>{{ok, 1}, {no_new_sample, 2}, {ok, 1}, {ok, 0.5}, {ok, 2}, {finished, 3}});
  Scripted& inner = *device;
  Recorder recorder(std::move(device), 100);
  DeviceSample sample;
  const ReadStatus expected[] = {ok, no_new_sample, ok, ok, ok, finished, lost, lost};
  double force = 1;
  for (const ReadStatus status : expected) {
    EXPECT_EQ(recorder.read(sample), status);
    recorder.write({force, 0, 0}, Vec3::Zero());
    EXPECT_EQ(inner.written.x(), force++);
  }
  EXPECT_EQ(recorder.dropped(), 2u);
  const Trajectory kept = parse_trajectory(format_trajectory(recorder.trajectory()), "recording");
  ASSERT_EQ(kept.rows.size(), 2u);
  EXPECT_EQ(kept.rows[0].time, 1);
  EXPECT_EQ(kept.rows[1].time, 2);
  EXPECT_EQ(kept.rows[0].force.x(), 1);
  EXPECT_EQ(kept.rows[1].force.x(), 5);
}

/// Runs its ticks in start_servo, three at most.
class ServoDriven final : public Device {
 public:
  ServoDriven() { info_.servo_driven = true; }
  const DeviceInfo& info() const noexcept override { return info_; }
  ReadStatus read(DeviceSample& sample) noexcept override {
    if (running && reads == 3) return ReadStatus::lost;
    sample = {};
    sample.time = static_cast<double>(reads++);
    return ReadStatus::ok;
  }
  void write(const Vec3&, const Vec3&) noexcept override {}
  void start_servo(const ServoTick& tick) override {
    running = true;
    while (tick.call(tick.context)) {
    }
  }
  void stop_servo() noexcept override { running = false; }
  const char* error_text() const noexcept override { return "unplugged"; }

  bool running = false;
  int reads = 0;

 private:
  DeviceInfo info_;
};

TEST(Recorder, RunsTheThreadOfItsDevice) {
  auto device = std::make_unique<ServoDriven>();
  ServoDriven& inner = *device;
  Recorder recorder(std::move(device), 100);
  ASSERT_TRUE(recorder.info().servo_driven);
  recorder.start_servo({.call =
                            [](void* context) noexcept {
                              DeviceSample sample;
                              return static_cast<Recorder*>(context)->read(sample) == ReadStatus::ok;
                            },
                        .context = &recorder});
  EXPECT_EQ(recorder.size(), 3u);
  EXPECT_TRUE(inner.running);
  recorder.stop_servo();
  EXPECT_FALSE(inner.running);
  EXPECT_STREQ(recorder.error_text(), "unplugged");
}

TEST(Recorder, RefusesBadCapacityAndNoDevice) {
  const auto open = [](std::size_t capacity) {
    return error_of([=] { Recorder(open_null({}, 1e-3), capacity); }).code();
  };
  EXPECT_EQ(open(0), Code::out_of_range);
  EXPECT_EQ(open(kMaxTrajectoryRows + 1), Code::out_of_range);
  EXPECT_EQ(open(static_cast<std::size_t>(-1)), Code::out_of_range);
  EXPECT_EQ(error_of([] { Recorder(nullptr, 10); }).code(), Code::null);
}

}  // namespace
}  // namespace crumble
