// The questions of fakehd.h.
#include "fakehd.h"

#include <algorithm>

#include "fakehd_state.hpp"

namespace fakehd {
namespace {

/// A value of a session, `none` for a handle that never was.
template <class T>
T of(unsigned handle, T Session::*member, T none = {}) {
  Guard s;
  const Session* d = find_session(*s, handle);
  return d ? d->*member : none;
}

void copy(unsigned handle, Vec Session::*member, double* out) {
  if (!out) return;
  const Vec value = of(handle, member);
  std::copy(value.begin(), value.end(), out);
}

void plug(unsigned handle, bool out) {
  Guard s;
  if (const Session* d = find_session(*s, handle)) s->unplugged[d->device] = out;
}

void clear(State& s) {
  s.sessions.clear();
  s.current = hd::kInvalidHandle;
  s.license_vendor.clear();
  s.license_application.clear();
  s.licensed = false;
  s.errors.clear();
  s.errors_pushed = s.misuse = s.ticks = s.missed = 0;
  s.misuse_text = "";
  s.tasks.clear();
  s.next_task = 0;
  s.rate = 1000;
  s.starts = 0;
}

}  // namespace
}  // namespace fakehd

using namespace fakehd;

int fakehd_reset(const char* script) {
  State& s = state();
  std::unique_lock lock(s.mutex);
  if (in_servo(s)) return -1;
  stop_scheduler(s, lock);
  wait_for_turn(s, lock);
  clear(s);
  load_script(s, script);
  return s.script_error.empty() ? 0 : -1;
}

const char* fakehd_script_error(void) {
  Guard s;
  return s->script_error.c_str();
}

long fakehd_run_ticks(long n) {
  Guard s;
  if (in_servo(*s) || !s->script.manual) return 0;
  long run = 0;
  for (; run < n; ++run) {
    wait_for_turn(*s, s.lock());
    if (!s->running) break;
    run_tick(*s, s.lock());
  }
  return run;
}

void fakehd_stall(double seconds) {
  Guard s;
  s->pretended += std::max(seconds, 0.0);
  check_watchdog(*s);
}

void fakehd_commanded_force(unsigned handle, double force[3]) {
  copy(handle, &Session::commanded, force);
}

void fakehd_applied_force(unsigned handle, double force[3]) {
  copy(handle, &Session::applied, force);
}

void fakehd_last_torque(unsigned handle, double torque[3]) {
  copy(handle, &Session::last_torque, torque);
}

void fakehd_force_integral(unsigned handle, double integral[3]) {
  copy(handle, &Session::integral, integral);
}

double fakehd_work(unsigned handle) {
  return of(handle, &Session::work);
}

double fakehd_peak_force(unsigned handle) {
  return of(handle, &Session::peak);
}

double fakehd_peak_slew(unsigned handle) {
  return of(handle, &Session::slew);
}

double fakehd_temperature(unsigned handle) {
  const auto all = of(handle, &Session::temperature);
  return *std::max_element(all.begin(), all.end());
}

void fakehd_set_temperature(unsigned handle, double t) {
  Guard s;
  if (Session* d = find_session(*s, handle)) d->temperature.fill(t);
}

void fakehd_position(unsigned handle, double position[3]) {
  copy(handle, &Session::position, position);
}

void fakehd_velocity(unsigned handle, double velocity[3]) {
  copy(handle, &Session::velocity, velocity);
}

void fakehd_place(unsigned handle, const double position[3]) {
  Guard s;
  Session* d = find_session(*s, handle);
  if (!d || !position) return;
  d->placed = true;
  d->position = d->place = {position[0], position[1], position[2]};
  d->velocity = {};
}

void fakehd_press_button(unsigned handle, unsigned mask) {
  Guard s;
  if (Session* d = find_session(*s, handle)) d->pressed = mask;
}

void fakehd_inkwell(unsigned handle, int in) {
  Guard s;
  if (Session* d = find_session(*s, handle)) d->inkwell = in ? 1 : 0;
}

void fakehd_unplug(unsigned handle) {
  plug(handle, true);
}

void fakehd_replug(unsigned handle) {
  plug(handle, false);
}

unsigned long fakehd_ticks(void) {
  return Guard()->ticks;
}

unsigned long fakehd_missed_ticks(void) {
  return Guard()->missed;
}

unsigned long fakehd_rate(void) {
  return Guard()->rate;
}

unsigned long fakehd_frames(unsigned handle) {
  return of(handle, &Session::frames);
}

unsigned fakehd_open_devices(void) {
  Guard s;
  const auto open = std::count_if(s->sessions.begin(), s->sessions.end(), [](const auto& d) { return d->open; });
  return static_cast<unsigned>(open);
}

int fakehd_is_open(unsigned handle) {
  return of(handle, &Session::open, false);
}

int fakehd_enabled(unsigned handle, unsigned capability) {
  Guard s;
  const Session* d = find_session(*s, handle);
  return d && is_enabled(*d, capability);
}

int fakehd_calibrated(unsigned handle) {
  return of(handle, &Session::calibrated, false);
}

int fakehd_scheduler_running(void) {
  return Guard()->running;
}

unsigned fakehd_scheduled(void) {
  return static_cast<unsigned>(Guard()->tasks.size());
}

unsigned fakehd_scheduler_starts(void) {
  return Guard()->starts;
}

const char* fakehd_license_vendor(void) {
  Guard s;
  return s->licensed ? s->license_vendor.c_str() : nullptr;
}

const char* fakehd_license_application(void) {
  Guard s;
  return s->licensed ? s->license_application.c_str() : nullptr;
}

unsigned long fakehd_errors_pushed(void) {
  return Guard()->errors_pushed;
}

unsigned fakehd_errors_pending(void) {
  return static_cast<unsigned>(Guard()->errors.size());
}

void fakehd_push_error(unsigned code, int internal, unsigned handle) {
  Guard s;
  push_error(*s, code, handle, internal);
}

unsigned long fakehd_misuse(void) {
  return Guard()->misuse;
}

const char* fakehd_misuse_text(void) {
  return Guard()->misuse_text;
}
