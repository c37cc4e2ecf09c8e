// One servo tick. Read this file first; src/sim/step.cpp is what it calls in the middle.
#include "crumble/base/clock.hpp"
#include "haptics/loop_state.hpp"

namespace crumble {

using haptics::HandChannel;

void HapticLoop::State::tick() noexcept {
  const double begin = wall_seconds();
  if (!gate.take()) return;  // the watchdog is at the devices
  const std::uint64_t order = ++status.ticks;

  // (1) where the hands are, as far as that can be believed
  for (std::size_t i = 0; i < hands.size(); ++i) hands[i].sense(requests[i]);

  // (2) where that puts the tools: each hangs on its hand by a spring, and the body has pushed it
  for (std::size_t i = 0; i < hands.size(); ++i) {
    poses[hands[i].holder()] = hands[i].move_tool(body->at(i, hands[i].tool()));
  }
  gate.leave();

  // (3) the body answers
  body->advance(poses, suspended(), order);

  // (4) what the hands feel: coupling, damping, safety stages, controller
  if (!gate.take()) return;  // it took too long: the watchdog is writing zeros
  const double age = body->age();
  for (std::size_t i = 0; i < hands.size(); ++i) {
    hands[i].feel(body->at(i, hands[i].tool()), age, body->status(), order);
  }
  gate.wrote(wall_seconds());

  // (5) and everybody may know
  report();
  gate.leave();
  measure(begin);
}

haptics::HandMask HapticLoop::State::suspended() const noexcept {
  haptics::HandMask mask = 0;
  for (std::size_t i = 0; i < hands.size(); ++i) {
    if (hands[i].suspended()) mask |= 1u << i;
  }
  return mask;
}

void HapticLoop::State::report() noexcept {
  status.steps = body->steps();
  status.time = body->time();
  status.missed = servo.missed();
  status.watchdog = watchdog_count.load(std::memory_order_relaxed);
  status.late_answers += body->age() > def.body_ticks * def.tick;
  for (std::size_t i = 0; i < hands.size(); ++i) hands[i].report(status.hands[i]);
  published.store(status);
}

void HapticLoop::State::measure(double begin) noexcept {
  wall.add(wall_seconds() - begin);
  if (last_begin > 0) period.add(begin - last_begin);
  if (first_begin == 0) first_begin = begin;
  last_begin = begin;
  const double since = begin - first_begin;
  if (since > 0) rate.store(static_cast<double>(period.count()) / since, std::memory_order_relaxed);
}

// Calls to the devices belong to the thread that does not come: it gets the fault when it does, and status at once.
void HapticLoop::State::tell_stalled() noexcept {
  for (std::size_t i = 0; i < hands.size(); ++i) {
    status.hands[i].state = HandState::faulted;
    status.hands[i].fault = Fault::stalled;
  }
  status.watchdog = watchdog_count.load(std::memory_order_relaxed);
  published.store(status);
}

// Every few milliseconds, by the watchdog's thread.
void HapticLoop::State::watch() noexcept {
  const double last = gate.last_write();
  if (last == 0 || wall_seconds() - last < kStopAge) return;
  for (std::size_t i = 0; i < hands.size(); ++i) requests[i].fault = Fault::stalled;
  if (!gate.take()) return;
  if (gate.last_write() == last) {
    gate.wrote(0);  // done; the next tick that comes through starts it again
    watchdog_count.store(watchdog_count.load(std::memory_order_relaxed) + 1, std::memory_order_relaxed);
    if (driving) {
      tell_stalled();
    } else {
      for (HandChannel& hand : hands) hand.take_force_away();
    }
  }
  gate.leave();
}

}  // namespace crumble
