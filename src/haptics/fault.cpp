#include "crumble/haptics/fault.hpp"

namespace crumble {

const char* to_string(Fault fault) noexcept {
  switch (fault) {
    case Fault::none:
      return "none";
    case Fault::not_finite:
      return "not_finite";
    case Fault::bad_pose:
      return "bad_pose";
    case Fault::speed:
      return "speed";
    case Fault::stalled:
      return "stalled";
    case Fault::silent:
      return "silent";
    case Fault::device_lost:
      return "device_lost";
    case Fault::body:
      return "body";
    case Fault::halted:
      return "halted";
    case Fault::driver:
      return "driver";
  }
  return "unknown";
}

const char* reason(Fault fault) noexcept {
  switch (fault) {
    case Fault::none:
      return "no fault";
    case Fault::not_finite:
      return "a position, velocity or force was not a finite number";
    case Fault::bad_pose:
      return "the device told an orientation that is no rotation";
    case Fault::speed:
      return "the device moved faster than safety.max_speed, or jumped more than once";
    case Fault::stalled:
      return "the body gave no new answer for 20 ms";
    case Fault::silent:
      return "the device told nothing new for 20 ms";
    case Fault::device_lost:
      return "the device is lost: open it again";
    case Fault::body:
      return "the body left the world: reset the simulation";
    case Fault::halted:
      return "halt() was called";
    case Fault::driver:
      return "the device's own driver took the force away";
  }
  return "unknown fault";
}

}  // namespace crumble
