// What a device's handle stands for.
#pragma once

#include <atomic>
#include <memory>

#include "custom_device.hpp"
#include "handles.hpp"

namespace crumble::capi {

struct OpenDevice {
  using Handle = crumble_device;
  static constexpr const char* kName = "device";
  static HandleTable table;

  /// What a callback answered when it made the device lost; else 0. Any thread.
  crumble_result callback_error() const noexcept { return custom ? custom->error() : CRUMBLE_OK; }

  std::unique_ptr<Device> device;
  const CustomDevice* custom = nullptr;  // the same, if it is one
  std::atomic<std::uint32_t> loops{0};   // that need it
};

}  // namespace crumble::capi
