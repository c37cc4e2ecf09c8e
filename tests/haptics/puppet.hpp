// A device on strings: tells what the test wants, keeps what it is sent.
#pragma once

#include <vector>

#include "crumble/device/device.hpp"

namespace crumble {

class Puppet : public Device {
 public:
  explicit Puppet(double tick = 1e-3) : tick_(tick) {
    info_.name = "puppet";
    info_.max_force = 3.3;
    info_.mass = 0.075;
    info_.measured = quantity::kPosition | quantity::kOrientation | quantity::kButtons;
  }
  DeviceInfo& info() noexcept { return info_; }
  const DeviceInfo& info() const noexcept override { return info_; }

  ReadStatus read(DeviceSample& out) noexcept override {
    if (status == ReadStatus::ok || status == ReadStatus::finished) {
      sample.time = static_cast<double>(reads) * tick_;
      sample.sequence = reads;
      out = sample;
    }
    ++reads;
    return status;
  }
  void write(const Vec3& f, const Vec3& t) noexcept override {
    force = f, torque = t;
    ++writes;
  }

  // told
  DeviceSample sample;
  ReadStatus status = ReadStatus::ok;
  // kept
  Vec3 force = Vec3::Zero(), torque = Vec3::Zero();
  std::uint64_t reads = 0, writes = 0;

 private:
  DeviceInfo info_;
  double tick_;
};

/// One that calls, as the driver of a maker does: its thread is whoever calls turn().
class Caller final : public Puppet {
 public:
  explicit Caller(const void* group = nullptr) {
    info().servo_driven = true;
    info().servo_group = group;
    info().rate = 1000;
  }
  void start_servo(const ServoTick& tick) override { servo = tick; }
  void stop_servo() noexcept override { servo = {}; }
  void turn(int times = 1) {
    for (int i = 0; i < times && servo.call; ++i) servo.call(servo.context);
  }
  ServoTick servo;
};

}  // namespace crumble
