// PHANToM and Touch devices of Sensable, Geomagic and 3D Systems.
//
// Implements the HDAPI 3.x ABI, which is loaded at run time: nothing of the maker's is needed to build or to run until
// such a device is opened. Verified against a documented-behaviour double of that library (tests/fakehd); no hardware
// has been used. docs/devices.md says what that leaves open.
#pragma once

#include <memory>
#include <string>

#include "crumble/device/device.hpp"

namespace crumble {

struct PhantomOptions {
  std::string library = {};      // path of HDAPI; empty: that in the environment variable CRUMBLE_HDAPI, else libHD.so
                                 // and the names of its versions
  std::string name = {};         // as in the driver's configuration; empty: none, "Default Device", "Default PHANToM"
  double rate = 1000;            // Hz of the driver's thread, 500 to 8000; a driver that does not take it keeps its own
  Vec3 tip = Vec3::Zero();       // m, in the stylus's frame, from where its axes meet, whose position the driver tells
  bool torque = false;           // experimental: torques too, where the device has six motors
  bool reset_encoders = false;   // the arm is being held in its reset position: take it for that. Premium models
  bool disable_on_close = true;  // some FireWire models are said to crash by that

  // Of commercial programs, which 3D Systems asks to have one
  std::string license_vendor = {}, license_application = {}, license_password = {};
};

/// Servo-driven: read and write work in the tick that is given to start_servo, which the driver's thread calls. All
/// devices of a process share that thread, so the tick of one may read and write the others; they are opened while it
/// does not run. A tick that writes nothing sends zero.
///
/// Where the driver reports that it took the force away, samples are flagged kForceOff; motors that it calls hot count
/// as at their limit; an unplugged device is lost. error_text() says why, and how to calibrate.
///
/// Throws Error: unsupported (no such library, with the loader's words; license refused), device_lost (no device, with
/// the driver's words), state (open already; the servo thread of another one runs; another library is loaded),
/// invalid_value, out_of_range (rate; also one that differs from that of a device open already), too_large (more than
/// four).
std::unique_ptr<Device> open_phantom(const PhantomOptions& options);

/// Whether HDAPI can be loaded, as open_phantom would; if not, why. Loads it.
struct PhantomLibrary {
  std::string path;     // empty: it cannot
  std::string version;  // as it tells
  std::string reason;
};
PhantomLibrary find_phantom_library(const std::string& library = {});

}  // namespace crumble
