// From the force that was set to the one that the motors give: limits first, then the amplifiers and their ramp.
#include <algorithm>
#include <cmath>

#include "fakehd_state.hpp"

namespace fakehd {
namespace {

constexpr double kOffTime = 0.1;  // s, that the amplifiers stay off after a fault
constexpr double kWarm = 0.9;     // of 1

/// The bit of a capability, 0 if there is none of this name.
unsigned bit_of(unsigned capability) {
  switch (capability) {
    case hd::kForceOutput:
      return 1;
    case hd::kMaxForceClamping:
      return 2;
    case hd::kForceRamping:
      return 4;
    case hd::kSoftwareForceLimit:
      return 8;
    case hd::kOneFrameLimit:
      return 16;
    case hd::kSoftwareVelocityLimit:
      return 32;
    case hd::kSoftwareForceImpulseLimit:
      return 64;
    default:
      return 0;
  }
}

/// By the norm, so that the direction stays.
Vec clamped(const Vec& force, double most) {
  const double size = norm(force);
  return size > most ? scaled(force, most / size) : force;
}

/// What a force is allowed to be; nothing after an error.
Vec limited_force(State& s, Session& d, const Vec& wanted) {
  const double most = script_of(s, d).max_force;
  Vec force = wanted;
  if (is_enabled(d, hd::kMaxForceClamping)) {
    force = clamped(force, most);
  } else if (is_enabled(d, hd::kSoftwareForceLimit) && norm(force) > most) {
    push_error(s, hd::kExceededMaxForce, d.handle);
    trip(s, d);
    return {};
  }
  // The documents give both N and N/ms as its unit: taken as N/ms.
  const double change = norm(minus(force, d.limited)) * static_cast<double>(s.rate) / 1000;
  if (is_enabled(d, hd::kSoftwareForceImpulseLimit) && change > d.impulse_limit * (1 + 1e-9)) {
    push_error(s, hd::kExceededMaxForceImpulse, d.handle);
    trip(s, d);
    return {};
  }
  return force;
}

void set_enabled(State& s, unsigned capability, bool on) {
  Session* d = current_session(s);
  if (!d) return;
  const unsigned bit = bit_of(capability);
  if (bit == 0) {
    refuse(s, hd::kInvalidEnum, "a capability that does not exist", d->handle);
    return;
  }
  d->enabled = on ? d->enabled | bit : d->enabled & ~bit;
  if (!is_enabled(*d, hd::kForceOutput)) d->applied = {};
}

void check_set_force(State& s, Session& d) {
  if (!finite(d.force) || !finite(d.torque) || !finite(d.joint_torque)) {
    refuse(s, hd::kForceError, "a force that is not finite", d.handle);
    d.force = d.torque = d.joint_torque = {};
  }
  if (norm(d.force) == 0) return;
  if (!d.calibrated) misuse(s, "a force before the calibration");
  if (*std::max_element(d.temperature.begin(), d.temperature.end()) > kWarm) push_error(s, hd::kWarmMotors, d.handle);
}

}  // namespace

bool is_enabled(const Session& d, unsigned capability) {
  return (d.enabled & bit_of(capability)) != 0;
}

unsigned default_capabilities() {
  return bit_of(hd::kMaxForceClamping) | bit_of(hd::kForceRamping) | bit_of(hd::kSoftwareForceLimit) |
         bit_of(hd::kOneFrameLimit) | bit_of(hd::kSoftwareVelocityLimit) | bit_of(hd::kSoftwareForceImpulseLimit);
}

void trip(State& s, Session& d) {
  d.off_ticks = static_cast<std::uint64_t>(std::ceil(kOffTime * static_cast<double>(s.rate)));
  d.gain = 0;
  d.applied = d.limited = {};
}

void begin_force(State&, Session& d) {
  d.force = d.torque = d.joint_torque = {};
  d.joint_torque_set = false;
}

void send_force(State& s, Session& d) {
  check_set_force(s, d);
  d.last_force = d.commanded = d.force;
  d.last_torque = d.torque;
  d.last_joint_torque = d.joint_torque;
  d.limited = limited_force(s, d, d.joint_torque_set ? Vec{} : d.force);
  const bool on = s.running && is_enabled(d, hd::kForceOutput) && !d.lost;
  d.applied = on ? scaled(d.limited, d.gain) : Vec{};
}

void end_force(State& s, Session& d) {
  if (d.frame_open) {
    misuse(s, "a frame left open at the end of its tick");
    d.frame_open = false;
    d.frames_this_tick = 0;
  }
  if (d.frames_this_tick == 0) d.applied = d.commanded = d.limited = {};
  d.peak = std::max(d.peak, norm(d.applied));
  d.slew = std::max(d.slew, norm(minus(d.applied, d.applied_before)));
  d.applied_before = d.applied;
}

}  // namespace fakehd

using namespace fakehd;

void hdEnable(unsigned capability) {
  Guard s;
  set_enabled(*s, capability, true);
}

void hdDisable(unsigned capability) {
  Guard s;
  set_enabled(*s, capability, false);
}

unsigned char hdIsEnabled(unsigned capability) {
  Guard s;
  const Session* d = current_session(*s);
  if (!d) return 0;
  if (bit_of(capability) == 0) refuse(*s, hd::kInvalidEnum, "a capability that does not exist", d->handle);
  return is_enabled(*d, capability) ? 1 : 0;
}
