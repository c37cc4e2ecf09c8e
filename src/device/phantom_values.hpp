// From what HDAPI tells to what a Device tells: units, frames, limits, words.
#pragma once

#include <array>

#include "crumble/device/phantom.hpp"
#include "device/hd_driver.hpp"

namespace crumble::device::hd {

/// What the current device and its driver tell of themselves. `options`: what was asked for.
DeviceInfo read_info(Driver& driver, const PhantomOptions& options);

/// Of a column-major 4 x 4 transform in mm, whose rotation is a little off. One that is no rotation at all gives an
/// orientation of length 0, which no loop believes.
Pose to_pose(const double (&transform)[16]) noexcept;

/// How a device that is calibrated in one of `styles` gets so.
const char* calibration_advice(unsigned styles) noexcept;

using ErrorBuffer = std::array<char, 160>;
/// Name, meaning and internal code, without taking memory.
void write_error_text(unsigned code, int internal_code, ErrorBuffer& out) noexcept;

}  // namespace crumble::device::hd
