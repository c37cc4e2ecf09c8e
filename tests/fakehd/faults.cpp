// Faults of the script, by tick, and the errors that a device raises by itself.
#include <limits>

#include "fakehd_state.hpp"

namespace fakehd {
namespace {

constexpr int kUnplugged = -28;   // the internal code that users report with a communication error
constexpr double kTeleport = 50;  // mm
constexpr double kHot = 0.95;

void error_and_trip(State& s, Session& d, unsigned code, int internal) {
  push_error(s, code, d.handle, internal);
  trip(s, d);
}

void raise(State& s, Session& d, const Fault& fault) {
  switch (fault.kind) {
    case FaultKind::comm_error:
      s.unplugged[d.device] = true;
      break;
    case FaultKind::device_fault:
      error_and_trip(s, d, hd::kDeviceFault, fault.internal);
      break;
    case FaultKind::exceeded_force:
      error_and_trip(s, d, hd::kExceededMaxForce, fault.internal);
      break;
    case FaultKind::exceeded_velocity:
      error_and_trip(s, d, hd::kExceededMaxVelocity, fault.internal);
      break;
    case FaultKind::timer_error:
      push_error(s, hd::kTimerError, d.handle, fault.internal);
      break;
    case FaultKind::warm_motors:
      push_error(s, hd::kWarmMotors, d.handle, fault.internal);
      d.temperature.fill(kHot);
      break;
    case FaultKind::error:
      push_error(s, fault.code, d.handle, fault.internal);
      break;
    case FaultKind::init_error:
      break;
    default:
      d.corrupt_until[static_cast<std::size_t>(fault.kind)] = s.ticks + 1;
  }
}

bool corrupted(const State& s, const Session& d, FaultKind kind) {
  return s.ticks < d.corrupt_until[static_cast<std::size_t>(kind)];
}

void refresh_report(State& s, Session& d) {
  if (corrupted(s, d, FaultKind::freeze)) return;
  d.now = make_report(s, d);
  if (corrupted(s, d, FaultKind::nan_position)) {
    d.now.position[1] = d.now.transform[13] = std::numeric_limits<double>::quiet_NaN();
  }
  if (corrupted(s, d, FaultKind::inf_velocity)) d.now.velocity[0] = std::numeric_limits<double>::infinity();
  if (corrupted(s, d, FaultKind::teleport)) {
    d.now.position[0] += kTeleport;
    d.now.transform[12] += kTeleport;
  }
  if (corrupted(s, d, FaultKind::bad_transform)) {
    for (std::size_t i = 0; i < 3; ++i) d.now.transform[i] = d.now.transform[4 + i];  // no volume
  }
}

void check_velocity(State& s, Session& d) {
  const bool watched = is_enabled(d, hd::kForceOutput) && is_enabled(d, hd::kSoftwareVelocityLimit) && d.off_ticks == 0;
  if (watched && d.calibrated && norm(d.smoothed) > d.velocity_limit) {
    error_and_trip(s, d, hd::kExceededMaxVelocity, 0);
  }
}

}  // namespace

void apply_faults(State& s) {
  for (auto& d : s.sessions) {
    if (!d->open) continue;
    for (const Fault& fault : s.script.faults) {
      const bool due = s.ticks >= fault.tick && s.ticks - fault.tick < fault.count;
      if (due && fault.device == d->device) raise(s, *d, fault);
    }
    if (s.unplugged[d->device]) d->lost = true;
    if (d->lost) {
      push_error(s, hd::kCommError, d->handle, kUnplugged);
      d->applied = {};
    } else {
      refresh_report(s, *d);
      check_velocity(s, *d);
    }
  }
}

}  // namespace fakehd
