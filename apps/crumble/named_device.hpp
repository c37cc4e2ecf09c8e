// The devices that the command line opens, by one word: --device.
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "crumble/device/device.hpp"
#include "crumble/device/replay.hpp"

namespace crumble::app {

struct DeviceChoice {
  std::string name = "hand";  // see kDeviceHelp
  std::string library = {};   // of HDAPI; empty: wherever it is
  double encoder_step = 0;    // m, of the hand's device
  double rate = 1000;         // Hz
  // Scripted motions: from so far above the origin of the device to so deep below it
  double clearance = 1e-3, depth = 6e-3;  // m
  ReplayClock clock = ReplayClock::step_locked;
};

inline constexpr const char* kDeviceHelp =
    "hand, press:MM_PER_S, poke:MM_PER_S, wander:SEED, tremor:SEED, replay:FILE, phantom[:NAME] or "
    "inverse3[:HOST[:PORT]]";

struct NamedDevice {
  std::unique_ptr<Device> device;
  std::optional<double> seconds;  // of its motion; none: it has no end
};

/// Throws Error naming --device and what is wrong with it.
void check(const DeviceChoice& choice);
/// Throws Error.
NamedDevice open_named(const DeviceChoice& choice);

}  // namespace crumble::app
