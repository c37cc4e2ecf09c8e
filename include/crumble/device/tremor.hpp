// The tremor that every hand has, alone or on top of another device's motion.
#pragma once

#include <memory>

#include "crumble/device/device.hpp"

namespace crumble {

/// Physiological tremor: along each axis a sum of eight sinusoids of one size, with random phases and with frequencies
/// from [low, high], one random in the middle half of each eighth. So no two are alike, and over a long time the root
/// of the mean square of the distance from `start` is `amplitude` exactly. It begins and ends at rest in `start`,
/// growing and fading for a second (for half of `seconds` if that is less).
struct TremorOptions {
  Pose start = {};          // m, device frame; add_tremor does not use it
  double amplitude = 1e-4;  // m, > 0, root mean square
  double low = 8;           // Hz, > 0
  double high = 12;         // Hz, > low, at most half the rate of the device
  std::uint64_t seed = 0;
  double seconds = 0;  // s, >= 0; 0: without end
};

/// Step-locked: read k (from 0) gives time k * tick; two devices of one seed give the same bits.
/// Throws Error naming the field of the option (bad_pose, invalid_value, out_of_range), or the tick.
std::unique_ptr<Device> open_tremor(const TremorOptions& options, double tick);

/// A device around a device: adds the tremor at each sample's time to its position and velocity and passes everything
/// else through. What it adds to the position stays as it is once the device has finished.
/// Throws Error: null, and what open_tremor throws.
std::unique_ptr<Device> add_tremor(std::unique_ptr<Device> device, const TremorOptions& options);

}  // namespace crumble
