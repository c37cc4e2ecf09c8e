// A device that the host has written, by callbacks.
#pragma once

#include <atomic>
#include <memory>

#include "crumble/crumble.h"
#include "crumble/device/device.hpp"

namespace crumble::capi {

class CustomDevice final : public Device {
 public:
  /// `callbacks` has been checked.
  explicit CustomDevice(const crumble_device_callbacks& callbacks);

  const DeviceInfo& info() const noexcept override { return info_; }
  [[nodiscard]] ReadStatus read(DeviceSample& sample) noexcept override;
  /// Of a lost device: zero, so that its motors do not hold what they had.
  void write(const Vec3& force, const Vec3& torque) noexcept override;
  void start_servo(const ServoTick& tick) override;
  void stop_servo() noexcept override;
  const char* error_text() const noexcept override { return error_text_.load(std::memory_order_relaxed); }

  /// What the first callback that failed answered; 0: none has. Any thread.
  crumble_result error() const noexcept { return error_.load(std::memory_order_relaxed); }

 private:
  template <class Callback, class... Arguments>
  bool call(const char* text, Callback callback, Arguments... arguments) noexcept;
  void lose(crumble_result result, const char* text) noexcept;
  static std::uint32_t tick(void* self) noexcept;

  crumble_device_callbacks callbacks_;
  DeviceInfo info_;
  ServoTick servo_;
  bool driving_ = false;     // between start and stop
  std::uint64_t count_ = 0;  // samples
  std::atomic<crumble_result> error_{CRUMBLE_OK};
  std::atomic<const char*> error_text_{""};
};

/// The calling thread is in a callback of some device.
bool in_callback() noexcept;

crumble_device_callbacks default_callbacks();
/// Throws Error: what crumble_device_open answers.
std::unique_ptr<CustomDevice> open_custom(const crumble_device_callbacks* callbacks);

}  // namespace crumble::capi
