// Why a hand gets no force. A fault is latched: it stays until somebody resets it.
#pragma once

#include <cstdint>

namespace crumble {

enum class Fault : std::uint8_t {
  none = 0,
  not_finite = 1,   // the device told, or the body answered, what is not a finite number
  bad_pose = 2,     // the device told an orientation that is no rotation
  speed = 3,        // the device moved faster than SafetyOptions::max_speed, or went on jumping
  stalled = 4,      // the body did not answer for kStopAge (haptics/safety.hpp)
  silent = 5,       // the device told nothing new for so long
  device_lost = 6,  // the device says that it is gone
  body = 7,         // the body left the world: HapticLoop's simulation must be reset
  halted = 8,       // somebody called halt()
  driver = 9,       // the device's own driver took the force away: Device::error_text() says why
};

/// "speed" and so on.
const char* to_string(Fault fault) noexcept;
/// The same as a sentence for people.
const char* reason(Fault fault) noexcept;

}  // namespace crumble
