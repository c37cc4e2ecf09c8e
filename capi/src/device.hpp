// What a device's handle stands for.
#pragma once

#include <atomic>
#include <memory>

#include "crumble/base/error.hpp"
#include "crumble/device/polled.hpp"
#include "crumble/device/recorder.hpp"
#include "custom_device.hpp"
#include "handles.hpp"

namespace crumble::capi {

struct OpenDevice : Allocated {
  using Handle = crumble_device;
  static constexpr const char* kName = "device";
  static HandleTable table;

  /// What a callback answered when it made the device lost; else 0. Any thread.
  crumble_result callback_error() const noexcept { return custom ? custom->error() : CRUMBLE_OK; }

  /// For threads that are not the device's own: starts its servo if it has one. Throws Error.
  Device& for_host() {
    if (!device->info().servo_driven) return *device;
    if (loops > 0) throw Error(Code::in_use, "a loop has the device, whose thread serves one at a time");
    if (!polled) polled = std::make_unique<PolledDevice>(*device);
    return *polled;
  }

  std::unique_ptr<Device> device;
  const Recorder* recorder = nullptr;    // the same, if what it tells is kept
  const CustomDevice* custom = nullptr;  // the same, or what is recorded, if it is one
  std::unique_ptr<PolledDevice> polled;  // round it, while the host reads and writes it without a loop
  std::atomic<std::uint32_t> loops{0};   // that need it
};

}  // namespace crumble::capi
