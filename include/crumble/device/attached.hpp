// What a user could plug in, and what of it is there.
#pragma once

#include <string>

#include "crumble/base/memory.hpp"
#include "crumble/device/device.hpp"
#include "crumble/device/inverse3.hpp"

namespace crumble {

struct AttachedDevice {
  DeviceKind kind = DeviceKind::phantom;
  std::string name;            // for people: what was found, and where
  bool can_be_opened = false;  // nothing that is needed is missing: open_device() is worth trying
  std::string note;            // what is missing, or how it is opened
};

struct AttachedOptions {
  std::string library = {};                  // as PhantomOptions::library
  std::string usb = "/sys/bus/usb/devices";  // folder in which the system (Linux) lists what is on USB
  bool ask_services = false;                 // of the Inverse3, by opening it for a moment: it gets zero force, which
                                             // another program that uses it may feel
  Inverse3Options inverse3 = {.timeout = 0.5};
};

/// Hardware on USB that the kinds of this build are for, and the drivers that they need. Opens no device (but see
/// ask_services); loads HDAPI if there is one. A device on Ethernet or FireWire is not seen: HDAPI cannot list, so
/// there the driver alone is told.
Vector<AttachedDevice> attached_devices(const AttachedOptions& options = {});

}  // namespace crumble
