// What a loop tells of itself after every tick, to any thread.
#pragma once

#include <array>
#include <cstdint>

#include "crumble/geometry/pose.hpp"
#include "crumble/haptics/passivity.hpp"
#include "crumble/haptics/safety.hpp"
#include "crumble/sim/step_info.hpp"

namespace crumble {

/// Hands of one loop, at most.
inline constexpr std::size_t kMaxHands = 4;

enum class HandState : std::uint8_t {
  waiting = 0,  // no force and no contact: for SafetyOptions::good_samples good samples, and the tool outside the body
  ramping = 1,  // force comes in
  running = 2,
  clutched = 3,  // the button is down: the tool stays, the hand moves freely
  faulted = 4,   // no force and no contact, until reset_fault()
};
/// "waiting" and so on.
const char* to_string(HandState state) noexcept;

struct HandStatus {
  HandState state = HandState::waiting;
  Fault fault = Fault::none;
  bool finished = false;                             // the device's motion is over
  std::uint32_t buttons = 0;                         // of the last sample
  std::uint32_t contacts = 0;                        // nodes that the tool holds
  double ramp = 0;                                   // share of the force that is let through, 0 to 1
  double time = 0;                                   // s, of the last sample, by the device's clock
  Pose device;                                       // device frame, m
  Vec3 velocity = Vec3::Zero();                      // m/s, device frame: what damping and guards go by
  Pose tool;                                         // in the scene, m; where the body meets it
  Wrench body;                                       // on the tool, scene: what the body did, N, N m
  Vec3 force = Vec3::Zero(), torque = Vec3::Zero();  // sent, device frame: N, N m
  double stiffness = 0;  // N/m that the hand feels at most: the coupling's, or the contacts'
  double damping = 0;    // N s/m injected now
  HandEnergy energy;
  SafetyCounters counters;
};

struct LoopStatus {
  std::uint64_t ticks = 0;
  std::uint64_t steps = 0;         // of the body
  std::uint64_t missed = 0;        // deadlines: ticks that never were. Simulated time lags by as many
  std::uint64_t late_answers = 0;  // ticks with an answer older than the body's own step takes
  std::uint64_t watchdog = 0;      // times that the watchdog took the force away
  double time = 0;                 // simulated s
  std::uint32_t hand_count = 0;
  std::array<HandStatus, kMaxHands> hands;
};

/// Of the times of a loop, s.
struct TimePercentiles {
  std::uint64_t count = 0;
  double p50 = 0, p99 = 0, p99_9 = 0, max = 0;
};

struct LoopTimes {
  TimePercentiles tick_wall;  // in tick()
  TimePercentiles tick_cpu;   // of the thread; only where the loop has a thread of its own
  TimePercentiles lateness;   // of waking up after the deadline; likewise
  TimePercentiles period;     // from tick to tick
  double rate = 0;            // ticks a second, mean since start
};

}  // namespace crumble
