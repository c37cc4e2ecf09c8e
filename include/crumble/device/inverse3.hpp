// Haply Inverse3, over the WebSocket of the service that its maker installs (default ws://localhost:10001).
//
// Written from public sources (docs.haply.co, version 3.5 of the service, and open programs that talk to it) and tested
// against a double of the service that was written from the same. Never tried on hardware: docs/devices.md tells what
// is known and what is assumed.
//
// Frames. Haply's default is right-handed with x right, y forward, z up; ours is x right, y up, z towards the user. So
// (x, y, z) there is (x, z, -y) here, for position, velocity, the vector part of the orientation and, backwards, force.
// The axes of the grip are renamed alike: the unit quaternion there is the unit quaternion here. A session that another
// basis was set for tells and takes everything in that basis; this one sets none.
#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "crumble/device/device.hpp"

namespace crumble {

struct Inverse3Options {
  std::string host = "localhost";
  std::uint16_t port = 10001;
  std::string device_id = {};  // as the service tells it; empty: the first in its list
  double timeout = 2;          // s, to connect and to hear of a first state
};

/// Since the device was opened.
struct Inverse3Counters {
  std::uint64_t messages = 0;   // all that came
  std::uint64_t samples = 0;    // of these, the ones with a state of this device
  std::uint64_t malformed = 0;  // and those that were no such message at all; ten in a row and the device is lost
  std::uint64_t starved = 0;    // times that the force went to zero because nothing was written for 20 ms
};

/// Has a network thread of its own, which hands over the newest sample and sends the newest force; read() and write()
/// only exchange with it. That thread sends zero force when nothing was written, or no state of the device came, for
/// 20 ms, and when it ends. The device is lost when the connection ends, when ten messages in a row are malformed and
/// when no state of it came for 0.5 s.
///
/// What of orientation, buttons and velocity the first state has is in info().measured; what turns up later is not
/// looked at. The orientation is that of the first wireless VerseGrip, at its own rate: the last one stays until
/// another comes. info().max_force is no limit of the device, which tells none: see kFallbackForce in the source.
class Inverse3 : public Device {
 public:
  /// Any thread.
  virtual Inverse3Counters counters() const noexcept = 0;
};

/// Throws Error: out_of_range (empty host, port 0, timeout), io (nothing there, or no answer in time), format (what
/// answers speaks another protocol), device_lost (no Inverse3 attached, or none with that id; lists those that are),
/// unsupported (this build was made without Boost.Beast).
std::unique_ptr<Inverse3> open_inverse3(const Inverse3Options& options);

}  // namespace crumble
