// The one state of the process behind the hd and fakehd functions, and what their sources share. Everything in it is
// guarded by one mutex, which is let go while a callback runs.
#pragma once

#include <array>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <deque>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "fakehd_script.hpp"
#include "hd_names.h"

namespace fakehd {

/// What a frame tells, in the units of HDAPI: mm, mm/s, rad.
struct Report {
  Vec position{}, velocity{};
  std::array<double, 16> transform{};  // column-major
  Vec joints{}, gimbal{};
  unsigned buttons = 0;
  bool in_inkwell = false;
};

/// One hdInitDevice. Its handle is its index; none is used twice, so that a stale handle is always a bad one.
struct Session {
  unsigned handle = 0;
  std::size_t device = 0;  // index into the script's
  bool open = true;
  bool lost = false;  // has seen a communication error: no cure but a new hdInitDevice
  bool calibrated = false;
  unsigned enabled = 0;  // bits of the capabilities
  double velocity_limit = 0, impulse_limit = 0, ramp_time = 0;
  int status_light = 0;

  // The hand: m, m/s
  double time = 0;
  Vec position{}, velocity{}, place{};
  bool placed = false;
  unsigned pressed = 0;
  int inkwell = -1;                                        // -1: as the script says
  Vec smoothed{};                                          // mm/s
  Report now, frame, last;                                 // of this tick, of the last hdBeginFrame, of that before
  std::array<std::uint64_t, kFaultKinds> corrupt_until{};  // tick, by kind

  // Frame and force
  bool frame_open = false;
  int frames_this_tick = 0;
  std::uint64_t frames = 0;
  bool joint_torque_set = false;
  Vec force{}, torque{}, joint_torque{};                 // set in this frame
  Vec last_force{}, last_torque{}, last_joint_torque{};  // sent
  Vec commanded{}, limited{}, applied{}, applied_before{};
  double gain = 0;              // of the ramp
  std::uint64_t off_ticks = 0;  // left until the amplifiers come back
  std::array<double, 6> temperature{};
  Vec integral{};
  double work = 0, peak = 0, slew = 0;
};

struct Task {
  unsigned long handle = 0;
  HdCallback callback = nullptr;
  void* user = nullptr;
  unsigned short priority = 0;
};

struct State {
  std::mutex mutex;
  std::condition_variable changed;  // a task left, a tick ended, the scheduler stopped

  bool loaded = false;
  Script script;
  std::string script_error;
  std::vector<std::unique_ptr<Session>> sessions;
  std::vector<bool> unplugged;          // by device of the script
  std::vector<unsigned> init_failures;  // left, by device
  unsigned current = hd::kInvalidHandle;
  std::string license_vendor, license_application;
  bool licensed = false;

  std::deque<HdErrorInfo> errors;
  std::uint64_t errors_pushed = 0, misuse = 0;
  const char* misuse_text = "";

  std::vector<Task> tasks;
  unsigned long next_task = 0;
  bool running = false;
  unsigned long rate = 1000;
  double measured_rate = 0;
  unsigned starts = 0;
  std::uint64_t ticks = 0, missed = 0;
  std::thread thread;
  std::shared_ptr<std::atomic<bool>> stop;  // of that thread
  std::thread::id servo;                    // the thread that is in a tick
  std::chrono::steady_clock::time_point tick_start{};
  double pretended = 0;  // s, by fakehd_stall in this tick
  bool tripped = false;  // the watchdog, in this tick
};

/// Locked, the script read, and the watchdog looked at.
class Guard {
 public:
  Guard();
  State& operator*() const { return state_; }
  State* operator->() const { return &state_; }
  std::unique_lock<std::mutex>& lock() { return lock_; }

 private:
  State& state_;
  std::unique_lock<std::mutex> lock_;
};

State& state();

// errors.cpp
void push_error(State&, unsigned code, unsigned handle, int internal = 0);
void misuse(State&, const char* text);
/// Both: an error that only a wrong call can bring about.
void refuse(State&, unsigned code, const char* text, unsigned handle = hd::kInvalidHandle);

// device.cpp
void load_script(State&, const char* text);
Session* find_session(State&, unsigned handle);  // open or not
Session* open_session(State&, unsigned handle);  // refuses a bad handle
/// The current device for `call`, an error if there is none. Notes it when the wrong thread calls.
Session* current_session(State&);
void note_thread(State&);
inline const DeviceScript& script_of(const State& s, const Session& d) {
  return s.script.devices[d.device];
}

// scheduler.cpp
bool in_servo(const State&);
/// One tick on this thread. The lock is let go while callbacks run.
void run_tick(State&, std::unique_lock<std::mutex>&);
void call_task(State&, std::unique_lock<std::mutex>&, unsigned long handle);
const Task* find_task(const State&, unsigned long handle);
void check_watchdog(State&);
double tick_time(const State&);
void wait_for_turn(State&, std::unique_lock<std::mutex>&);  // until no tick is running
void stop_scheduler(State&, std::unique_lock<std::mutex>&);

// model.cpp, calibration.cpp, faults.cpp: before the callbacks of a tick
void advance(State&, Session&);
Report make_report(const State&, const Session&);
bool in_inkwell(const State&, const Session&);
unsigned calibration_style(Calibration);
unsigned calibration_status(const State&, const Session&);
void apply_faults(State&);

// force.cpp
void trip(State&, Session&);
void begin_force(State&, Session&);
void send_force(State&, Session&);
void end_force(State&, Session&);
bool is_enabled(const Session&, unsigned capability);
unsigned default_capabilities();  // all but the force itself

}  // namespace fakehd
