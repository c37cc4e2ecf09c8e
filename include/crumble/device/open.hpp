// One door to every kind of device, for those who choose the kind at run time.
#pragma once

#include <memory>
#include <span>
#include <string>
#include <string_view>

#include "crumble/device/hand.hpp"
#include "crumble/device/inverse3.hpp"
#include "crumble/device/phantom.hpp"
#include "crumble/device/poke.hpp"
#include "crumble/device/replay.hpp"
#include "crumble/device/scripted.hpp"
#include "crumble/device/tremor.hpp"
#include "crumble/device/wander.hpp"

namespace crumble {

struct DeviceDef {
  DeviceKind kind = DeviceKind::null;
  double tick = 1e-3;             // s, > 0: period of the step-locked kinds
  Pose rest = {};                 // kind null
  PressOptions press = {};        // kind press
  PathOptions path = {};          // kind path
  HandOptions hand = {};          // kind hand
  PhantomOptions phantom = {};    // kind phantom
  PokeOptions poke = {};          // kind poke
  TremorOptions tremor = {};      // kind tremor
  WanderOptions wander = {};      // kind wander
  ReplayOptions replay = {};      // kind replay
  std::string trajectory = {};    // kind replay: path of a .ctraj file
  Inverse3Options inverse3 = {};  // kind inverse3
};

/// The kinds that open_device can open in this build.
std::span<const DeviceKind> available_devices();
const char* to_string(DeviceKind kind);
/// Throws Error(unsupported) with the list of kinds when `name` is none.
DeviceKind device_kind(std::string_view name);

/// Throws Error(unsupported) with the list of available kinds for one that this build does not have, and what the
/// kind's own open function throws.
std::unique_ptr<Device> open_device(const DeviceDef& def);

}  // namespace crumble
