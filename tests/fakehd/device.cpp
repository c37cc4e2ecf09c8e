// Opens and closes devices, and knows which is the current one.
#include <algorithm>
#include <cstdlib>
#include <exception>

#include "fakehd_state.hpp"

namespace fakehd {
namespace {

std::size_t find_device(const State& s, const char* name) {
  const std::size_t none = s.script.devices.size();
  if (!name) return s.script.null_name_fails ? none : 0;
  for (std::size_t i = 0; i < none; ++i) {
    if (s.script.devices[i].name == name) return i;
  }
  const auto& names = s.script.default_names;
  return std::find(names.begin(), names.end(), name) == names.end() ? none : 0;
}

/// 0 when the device can be opened.
unsigned init_problem(State& s, std::size_t device) {
  if (device >= s.script.devices.size()) return hd::kCommConfigError;
  for (const auto& d : s.sessions) {
    if (d->open && d->device == device) return hd::kDeviceAlreadyInitiated;
  }
  if (s.unplugged[device]) return hd::kCommError;
  if (s.init_failures[device] == 0) return 0;
  --s.init_failures[device];
  return hd::kDeviceFault;
}

unsigned open_device(State& s, std::size_t device) {
  auto d = std::make_unique<Session>();
  const DeviceScript& script = s.script.devices[device];
  d->handle = static_cast<unsigned>(s.sessions.size());
  d->device = device;
  d->velocity_limit = script.velocity_limit;
  d->impulse_limit = script.impulse_limit;
  d->ramp_time = script.ramp_time;
  d->enabled = default_capabilities();
  d->calibrated = script.calibration == Calibration::none;
  d->temperature.fill(std::min(script.temperature, 1.0));
  d->position = script.trajectory.empty() ? script.hand.points.front().at : script.trajectory.front().at;
  s.current = d->handle;
  s.sessions.push_back(std::move(d));
  Session& opened = *s.sessions.back();
  opened.now = opened.frame = opened.last = make_report(s, opened);
  return opened.handle;
}

}  // namespace

State& state() {
  static State& only = *new State;  // never destroyed: the thread may outlive main
  return only;
}

Guard::Guard() : state_(state()), lock_(state_.mutex) {
  if (!state_.loaded) load_script(state_, std::getenv("FAKEHD_SCRIPT"));
  check_watchdog(state_);
}

void load_script(State& s, const char* text) {
  s.loaded = true;
  s.script_error.clear();
  try {
    s.script = parse_script(text);
  } catch (const std::exception& e) {
    s.script = {};
    s.script_error = e.what();
  }
  s.unplugged.assign(s.script.devices.size(), false);
  s.init_failures.assign(s.script.devices.size(), 0);
  for (const Fault& f : s.script.faults) {
    if (f.kind == FaultKind::init_error) s.init_failures[f.device] += static_cast<unsigned>(f.count);
  }
}

Session* find_session(State& s, unsigned handle) {
  return handle < s.sessions.size() ? s.sessions[handle].get() : nullptr;
}

void note_thread(State& s) {
  if (s.running && !in_servo(s)) misuse(s, "a device call outside the servo thread while the scheduler runs");
}

Session* open_session(State& s, unsigned handle) {
  note_thread(s);
  Session* d = find_session(s, handle);
  if (d && d->open) return d;
  refuse(s, hd::kBadHandle, "a handle that is not open", handle);
  return nullptr;
}

Session* current_session(State& s) {
  note_thread(s);
  Session* d = find_session(s, s.current);
  if (d && d->open) return d;
  refuse(s, hd::kBadHandle, "a device call without a current device", s.current);
  return nullptr;
}

}  // namespace fakehd

using namespace fakehd;

unsigned hdInitDevice(const char* name) {
  Guard s;
  note_thread(*s);
  const std::size_t device = find_device(*s, name);
  if (const unsigned problem = init_problem(*s, device)) {
    push_error(*s, problem, hd::kInvalidHandle);
    return hd::kInvalidHandle;
  }
  return open_device(*s, device);
}

void hdDisableDevice(unsigned device) {
  Guard s;
  Session* d = open_session(*s, device);
  if (!d) return;
  if (d->frame_open) misuse(*s, "hdDisableDevice within a frame");
  d->open = false;
  d->frame_open = false;
  d->enabled = 0;
  d->applied = d->commanded = {};
  if (s->current == device) s->current = hd::kInvalidHandle;
}

void hdMakeCurrentDevice(unsigned device) {
  Guard s;
  if (open_session(*s, device)) s->current = device;
}

unsigned hdGetCurrentDevice(void) {
  Guard s;
  return s->current;
}

unsigned char hdDeploymentLicense(const char* vendor, const char* application, const char* password) {
  Guard s;
  if (!s->sessions.empty()) misuse(*s, "hdDeploymentLicense after hdInitDevice");
  if (!vendor || !application || !password) {
    refuse(*s, hd::kInvalidValue, "hdDeploymentLicense with a null string");
    return 0;
  }
  if (s->script.license_refused) {
    push_error(*s, hd::kInvalidLicense, hd::kInvalidHandle);
    return 0;
  }
  s->licensed = true;
  s->license_vendor = vendor;
  s->license_application = application;
  return 1;
}
