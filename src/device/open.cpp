#include "crumble/device/open.hpp"

#include <array>

#include "crumble/base/error.hpp"

namespace crumble {
namespace {

constexpr std::array kAllKinds = {DeviceKind::null,   DeviceKind::press,  DeviceKind::replay,  DeviceKind::phantom,
                                  DeviceKind::custom, DeviceKind::path,   DeviceKind::hand,    DeviceKind::poke,
                                  DeviceKind::tremor, DeviceKind::wander, DeviceKind::inverse3};
// A custom device is handed over as an object; there is nothing to open.
constexpr std::array kAvailable = {
    DeviceKind::null,     DeviceKind::press, DeviceKind::replay, DeviceKind::phantom, DeviceKind::path,
    DeviceKind::hand,     DeviceKind::poke,  DeviceKind::tremor, DeviceKind::wander,
#ifdef CRUMBLE_HAS_INVERSE3
    DeviceKind::inverse3,
#endif
};

std::string list(std::span<const DeviceKind> kinds) {
  std::string text;
  for (const DeviceKind kind : kinds) text += (text.empty() ? "" : ", ") + std::string(to_string(kind));
  return text;
}

}  // namespace

std::span<const DeviceKind> available_devices() {
  return kAvailable;
}

const char* to_string(DeviceKind kind) {
  switch (kind) {
    case DeviceKind::null:
      return "null";
    case DeviceKind::press:
      return "press";
    case DeviceKind::replay:
      return "replay";
    case DeviceKind::phantom:
      return "phantom";
    case DeviceKind::custom:
      return "custom";
    case DeviceKind::path:
      return "path";
    case DeviceKind::hand:
      return "hand";
    case DeviceKind::poke:
      return "poke";
    case DeviceKind::tremor:
      return "tremor";
    case DeviceKind::wander:
      return "wander";
    case DeviceKind::inverse3:
      return "inverse3";
  }
  return "unknown";
}

DeviceKind device_kind(std::string_view name) {
  for (const DeviceKind kind : kAllKinds) {
    if (name == to_string(kind)) return kind;
  }
  throw Error(Code::unsupported, "device kind '" + std::string(name) + "' is none of: " + list(kAllKinds));
}

std::unique_ptr<Device> open_device(const DeviceDef& def) {
  switch (def.kind) {
    case DeviceKind::null:
      return open_null(def.rest, def.tick);
    case DeviceKind::press:
      return open_press(def.press, def.tick);
    case DeviceKind::path:
      return open_path(def.path, def.tick);
    case DeviceKind::hand:
      return open_hand(def.hand, def.tick);
    case DeviceKind::poke:
      return open_poke(def.poke, def.tick);
    case DeviceKind::tremor:
      return open_tremor(def.tremor, def.tick);
    case DeviceKind::wander:
      return open_wander(def.wander, def.tick);
    case DeviceKind::replay:
      return open_replay(read_trajectory(def.trajectory), def.replay, def.tick);
    case DeviceKind::inverse3:
      return open_inverse3(def.inverse3);
    case DeviceKind::phantom:
      return open_phantom(def.phantom);
    case DeviceKind::custom:
      break;
  }
  throw Error(Code::unsupported, "device kind " + std::string(to_string(def.kind)) +
                                     " cannot be opened by this build, which has: " + list(kAvailable));
}

}  // namespace crumble
