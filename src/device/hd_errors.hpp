// What an error of HDAPI means to a hand.
#pragma once

#include <cstdint>

namespace crumble::device::hd {

enum class ErrorClass : std::uint8_t {
  warm,       // the motors are hot: the driver still gives force
  force_off,  // the driver has taken the force away, or may have: nothing may push until somebody looks
  lost,       // the device is gone, or its servo thread
};

struct ErrorText {
  ErrorClass kind;
  const char* name;  // HDAPI's
  const char* text;  // for people
};
/// Of `code`, which is no success; unknown ones count as force_off.
const ErrorText& describe(unsigned code) noexcept;

}  // namespace crumble::device::hd
