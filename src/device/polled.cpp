#include "crumble/device/polled.hpp"

#include "crumble/base/clock.hpp"

namespace crumble {
namespace {

constexpr double kMostAge = 0.02;  // s of an order; haptics/safety.hpp has the same for what a body answers

}  // namespace

PolledDevice::PolledDevice(Device& device) : device_(device), info_(device.info()) {
  info_.servo_driven = false;
  info_.servo_group = nullptr;
  device_.start_servo({[](void* self) noexcept { return static_cast<PolledDevice*>(self)->tick(); }, this});
}

PolledDevice::~PolledDevice() {
  device_.stop_servo();
  device_.write(Vec3::Zero(), Vec3::Zero());
}

ReadStatus PolledDevice::read(DeviceSample& sample) noexcept {
  const ReadStatus before = told_.front().status;
  if (before == ReadStatus::lost) return before;
  if (!told_.fetch()) return ReadStatus::no_new_sample;
  const Told& told = told_.front();
  if (told.status == ReadStatus::ok || told.status == ReadStatus::finished) {
    sample = told.sample;
    if (force_off_.exchange(false)) sample.flags |= sample_flag::kForceOff;
  }
  return told.status;
}

void PolledDevice::write(const Vec3& force, const Vec3& torque) noexcept {
  orders_.back() = {force, torque, wall_seconds()};
  orders_.publish();
}

// In the device's thread.
bool PolledDevice::tick() noexcept {
  Told& told = told_.back();
  told.status = device_.read(told.sample);
  const bool lost = told.status == ReadStatus::lost;
  if (told.status != ReadStatus::no_new_sample) {
    if (told.sample.flags & sample_flag::kForceOff) force_off_ = true;
    told_.publish();
  }
  orders_.fetch();
  const Order& order = orders_.front();
  const bool renewed = !lost && wall_seconds() - order.time < kMostAge;
  device_.write(renewed ? order.force : Vec3::Zero(), renewed ? order.torque : Vec3::Zero());
  return !lost;
}

}  // namespace crumble
