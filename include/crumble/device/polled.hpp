// A device with a thread of its own, for those who want to read and write it from theirs.
#pragma once

#include <atomic>

#include "crumble/base/latest_value.hpp"
#include "crumble/device/device.hpp"

namespace crumble {

/// The device's thread does no more than exchange samples and forces, so it is never held up; what it tells and is told
/// is up to one of its periods old. A force that nobody renews for 20 ms becomes zero. For one thread at a time.
class PolledDevice final : public Device {
 public:
  /// Starts the servo of `device`, which is borrowed, and must be servo_driven. Throws what start_servo throws.
  explicit PolledDevice(Device& device);
  /// Stops it. Zero has been written then.
  ~PolledDevice() override;

  const DeviceInfo& info() const noexcept override { return info_; }
  [[nodiscard]] ReadStatus read(DeviceSample& sample) noexcept override;
  void write(const Vec3& force, const Vec3& torque) noexcept override;
  const char* error_text() const noexcept override { return device_.error_text(); }

 private:
  struct Told {
    ReadStatus status = ReadStatus::no_new_sample;
    DeviceSample sample;
  };
  struct Order {
    Vec3 force = Vec3::Zero(), torque = Vec3::Zero();
    double time = 0;  // wall clock, s
  };
  bool tick() noexcept;

  Device& device_;
  DeviceInfo info_;
  LatestValue<Told> told_{Told{}};
  LatestValue<Order> orders_{Order{}};
  std::atomic<bool> force_off_{false};  // in a sample that may have been overtaken by a later one
};

}  // namespace crumble
