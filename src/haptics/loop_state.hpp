// What a loop is made of.
#pragma once

#include <deque>

#include "crumble/base/memory.hpp"
#include "crumble/base/shared_value.hpp"
#include "crumble/device/polled.hpp"
#include "haptics/body_link.hpp"
#include "haptics/hand_channel.hpp"
#include "haptics/periodic_thread.hpp"
#include "haptics/watchdog.hpp"

namespace crumble {

struct HapticLoop::State : Allocated {
  State(Simulation& simulation, LoopDef definition);

  void tick() noexcept;
  bool skip_tick() noexcept;
  haptics::HandMask suspended() const noexcept;
  void report() noexcept;
  void measure(double begin) noexcept;
  void watch() noexcept;
  void tell_stalled() noexcept;

  Device* driving;                  // device that calls the ticks; null: none does
  std::deque<PolledDevice> polled;  // round those with a thread of their own that do not drive
  LoopDef def;
  Vector<std::string> warnings;
  Simulation& sim;
  haptics::Stepper stepper;
  std::unique_ptr<haptics::BodyLink> body;
  std::deque<haptics::HandChannel> hands;
  std::array<haptics::HandRequests, kMaxHands> requests;
  Vector<Pose> poses;  // by holder
  Vector<std::uint8_t> moved_by_hand;

  haptics::DeviceGate gate;
  haptics::PeriodicThread servo, watchdog;
  std::atomic<bool> running{false};

  // the ticking thread's
  LoopStatus status;
  double last_begin = 0, first_begin = 0;
  std::atomic<std::uint64_t> watchdog_count{0};
  std::atomic<double> rate{0};
  Histogram wall, period;
  SharedValue<LoopStatus> published;
};

}  // namespace crumble
