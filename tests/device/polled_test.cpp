#include "crumble/device/polled.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <thread>

#include "device/samples.hpp"

namespace crumble {
namespace {

/// Its thread is whoever calls turn().
class Servo final : public Device {
 public:
  const DeviceInfo& info() const noexcept override { return info_; }
  ReadStatus read(DeviceSample& out) noexcept override {
    if (status == ReadStatus::ok || status == ReadStatus::finished) out = sample;
    return status;
  }
  void write(const Vec3& f, const Vec3& t) noexcept override {
    force = f, torque = t;
    ++writes;
  }
  void start_servo(const ServoTick& tick) override {
    if (refuses) throw Error(Code::device_lost, "no thread");
    tick_ = tick;
  }
  void stop_servo() noexcept override { tick_ = {}; }
  const char* error_text() const noexcept override { return "pulled out"; }
  bool turn() { return tick_.call && tick_.call(tick_.context); }
  bool is_started() const { return tick_.call != nullptr; }

  DeviceSample sample;
  ReadStatus status = ReadStatus::ok;
  Vec3 force{9, 9, 9}, torque{9, 9, 9};
  int writes = 0;
  bool refuses = false;

 private:
  DeviceInfo info_{.name = "servo", .rate = 1000, .servo_driven = true, .servo_group = this};
  ServoTick tick_;
};

TEST(Polled, TellsTheNewestSampleOnce) {
  Servo servo;
  PolledDevice device(servo);
  EXPECT_FALSE(device.info().servo_driven);
  EXPECT_EQ(device.info().servo_group, nullptr);
  EXPECT_EQ(device.info().name, "servo");
  DeviceSample sample;
  sample.sequence = 77;
  EXPECT_EQ(device.read(sample), ReadStatus::no_new_sample);
  EXPECT_EQ(sample.sequence, 77u);
  for (std::uint64_t i = 0; i < 3; ++i) {
    servo.sample.sequence = i;
    EXPECT_TRUE(servo.turn());
  }
  EXPECT_EQ(device.read(sample), ReadStatus::ok);
  EXPECT_EQ(sample.sequence, 2u);
  EXPECT_EQ(device.read(sample), ReadStatus::no_new_sample);
  servo.status = ReadStatus::no_new_sample;
  EXPECT_TRUE(servo.turn());
  EXPECT_EQ(device.read(sample), ReadStatus::no_new_sample);
  servo.status = ReadStatus::finished;
  EXPECT_TRUE(servo.turn());
  EXPECT_EQ(device.read(sample), ReadStatus::finished);
}

TEST(Polled, PassesTheNewestForceOn) {
  Servo servo;
  PolledDevice device(servo);
  servo.turn();
  EXPECT_EQ(servo.force, Vec3(0, 0, 0)) << "nobody has given any";
  device.write({1, 2, 3}, {4, 5, 6});
  EXPECT_EQ(servo.force, Vec3(0, 0, 0)) << "only in its own thread";
  device.write({1, 2, 4}, {4, 5, 7});
  servo.turn();
  EXPECT_EQ(servo.force, Vec3(1, 2, 4));
  EXPECT_EQ(servo.torque, Vec3(4, 5, 7));
}

TEST(Polled, AForceThatNobodyRenewsBecomesZero) {
  Servo servo;
  PolledDevice device(servo);
  device.write({1, 0, 0}, {0, 0, 0});
  std::this_thread::sleep_for(std::chrono::milliseconds(25));
  servo.turn();
  EXPECT_EQ(servo.force, Vec3(0, 0, 0));
}

TEST(Polled, ALostDeviceStaysSoAndGetsZero) {
  Servo servo;
  PolledDevice device(servo);
  servo.turn();
  device.write({1, 0, 0}, {0, 0, 0});
  servo.status = ReadStatus::lost;
  EXPECT_FALSE(servo.turn()) << "its thread need not come again";
  EXPECT_EQ(servo.force, Vec3(0, 0, 0));
  DeviceSample sample;
  EXPECT_EQ(device.read(sample), ReadStatus::lost);
  EXPECT_EQ(device.read(sample), ReadStatus::lost);
  EXPECT_STREQ(device.error_text(), "pulled out");
}

TEST(Polled, AForceThatTheDriverTookIsNotOverlooked) {
  Servo servo;
  PolledDevice device(servo);
  servo.sample.flags = sample_flag::kForceOff;
  servo.turn();
  servo.sample.flags = 0;
  servo.turn();  // overtakes the one with the flag
  DeviceSample sample;
  EXPECT_EQ(device.read(sample), ReadStatus::ok);
  EXPECT_EQ(sample.flags, sample_flag::kForceOff);
  servo.turn();
  EXPECT_EQ(device.read(sample), ReadStatus::ok);
  EXPECT_EQ(sample.flags, 0u) << "told once";
}

TEST(Polled, StopsWithZeroAndStartsOrSaysWhyNot) {
  Servo servo;
  {
    PolledDevice device(servo);
    EXPECT_TRUE(servo.is_started());
    device.write({1, 0, 0}, {0, 0, 0});
    servo.turn();
  }
  EXPECT_FALSE(servo.is_started());
  EXPECT_EQ(servo.force, Vec3(0, 0, 0));
  servo.refuses = true;
  EXPECT_EQ(error_of([&] { PolledDevice{servo}; }).code(), Code::device_lost);
}

}  // namespace
}  // namespace crumble
