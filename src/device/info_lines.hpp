// What a device is, as header lines of a trajectory: a replay has the limits of the device that was recorded, so that a
// loop around it does what it did then.
#pragma once

#include <string>

#include "crumble/base/memory.hpp"
#include "crumble/device/trajectory.hpp"

namespace crumble::device {

Vector<std::string> info_lines(const DeviceInfo& info);
/// Those that are there, over what `info` has. Throws Error(format) naming a line that does not read.
void read_info_lines(const Trajectory& trajectory, DeviceInfo& info);

}  // namespace crumble::device
