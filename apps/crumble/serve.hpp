// A device without a body: whoever wants its samples, and tells it what force to give.
#pragma once

#include <functional>
#include <optional>

#include "crumble/device/device.hpp"

namespace crumble::app {

/// Gets what a read gave, and answers with the force, N, device frame; nothing: it has seen enough.
using Server = std::function<std::optional<Vec3>(ReadStatus, const DeviceSample&)>;

/// Calls `server` at the device's own pace: in its thread if it has one, as fast as possible if it is step-locked, else
/// `rate` times a second. Returns when the server has enough, after `seconds` by the clock, or when the process is
/// asked to end (SIGINT); zero force has been written then. The status of the last read. Throws what start_servo
/// throws.
ReadStatus serve(Device& device, double rate, double seconds, const Server& server);

}  // namespace crumble::app
