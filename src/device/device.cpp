#include "crumble/device/device.hpp"

#include "crumble/base/error.hpp"

namespace crumble {

void Device::start_servo(const ServoTick&) {
  throw Error(Code::unsupported, "device '" + info().name + "' has no thread of its own");
}

}  // namespace crumble
