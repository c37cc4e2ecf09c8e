#include "crumble/haptics/loop.hpp"

#include <algorithm>

#include "crumble/base/clock.hpp"
#include "crumble/base/memory.hpp"
#include "haptics/loop_def.hpp"
#include "haptics/loop_state.hpp"

namespace crumble {
namespace {

constexpr double kWatchPeriod = 2e-3;
constexpr double kStartTime = 1;  // s that a device may take to its first tick

Vector<std::uint32_t> holders_of(const LoopDef& def) {
  Vector<std::uint32_t> holders;
  for (const HandDef& hand : def.hands) holders.push_back(hand.holder);
  return holders;
}

void require_stopped(bool running, const char* what) {
  if (running) throw Error(Code::state, std::string(what) + " while the loop runs");
}

TimePercentiles percentiles(const Histogram& h) {
  return {h.count(), h.quantile(0.5), h.quantile(0.99), h.quantile(0.999), h.greatest()};
}

// Above the loop's own: a step that never ends must not keep the watchdog from its processor.
int watchdog_priority(const ThreadOptions& loop) {
  return loop.priority > 0 ? std::min(loop.priority + 1, 99) : 0;
}

bool tick_again(void* loop) noexcept {
  static_cast<HapticLoop*>(loop)->tick();
  return true;
}

}  // namespace

void apply_paper_preset(LoopDef& def) {
  def.coupling = BodyCoupling::paper;
  for (HandDef& hand : def.hands) {
    hand.coupling.enabled = false;
    hand.passivity.inject_damping = hand.passivity.controller = false;
  }
}

HapticLoop::State::State(Simulation& simulation, LoopDef definition)
    : driving((haptics::check(simulation, definition), haptics::driving_device(definition))),
      def(haptics::with_polled(std::move(definition), driving, polled)),
      warnings(haptics::find_warnings(def)),
      sim(simulation),
      stepper(simulation, holders_of(def)),
      body(def.coupling == BodyCoupling::direct ? haptics::make_direct_link(stepper)
                                                : haptics::make_model_link(stepper, def)),
      poses(simulation.holder_count()),
      moved_by_hand(simulation.holder_count(), 0) {
  for (const HandDef& hand : def.hands) {
    hands.emplace_back(hand, def.tick, haptics::mean_of(sim, def), 2 * def.tick * def.body_ticks);
    moved_by_hand[hand.holder] = 1;
  }
  status.hand_count = static_cast<std::uint32_t>(hands.size());
  published.store(status);
}

HapticLoop::HapticLoop(Simulation& sim, LoopDef def) : state_(std::make_unique<State>(sim, std::move(def))) {}

HapticLoop::~HapticLoop() {
  stop();
}

const LoopDef& HapticLoop::definition() const noexcept {
  return state_->def;
}

const Vector<std::string>& HapticLoop::warnings() const noexcept {
  return state_->warnings;
}

void HapticLoop::place(std::size_t holder, const Pose& pose) {
  require_stopped(running(), "a holder cannot be placed");
  if (holder >= state_->poses.size()) {
    throw Error(Code::out_of_range,
                "holder is " + std::to_string(holder) + ", the simulation has " + std::to_string(state_->poses.size()));
  }
  if (state_->moved_by_hand[holder]) throw Error(Code::state, "holder " + std::to_string(holder) + " is a hand's");
  if (!is_valid(pose)) throw Error(Code::bad_pose, "pose must have a finite position and | |q| - 1 | <= 1e-3");
  state_->poses[holder] = renormalized(pose);
}

void HapticLoop::publish_to(StatePublisher& publisher) {
  require_stopped(running(), "a publisher cannot be added");
  state_->stepper.publishers.push_back(&publisher);
}

void HapticLoop::forget_publishers() {
  require_stopped(running(), "a publisher cannot be taken away");
  state_->stepper.publishers.clear();
}

void HapticLoop::record_to(Recording* recording) {
  require_stopped(running(), "a recording cannot be begun or ended");
  state_->stepper.recording = recording;
}

void HapticLoop::start() {
  State& s = *state_;
  if (s.running.exchange(true)) throw Error(Code::state, "the loop runs already");
  try {
    s.stepper.changes.open(s.sim.definition());
    s.gate.wrote(s.driving ? wall_seconds() + kStartTime : 0);
    s.body->start();
    if (s.def.watchdog) {
      s.watchdog.start(
          kWatchPeriod, {.priority = watchdog_priority(s.def.thread)},
          [](void* state) noexcept {
            static_cast<State*>(state)->watch();
            return true;
          },
          &s);
    }
    if (s.driving) s.driving->start_servo({tick_again, this});
    if (!s.driving && s.def.driver != LoopDriver::host) s.servo.start(s.def.tick, s.def.thread, tick_again, this);
  } catch (...) {
    stop();
    throw;
  }
}

void HapticLoop::change(const std::function<void(SimulationDef&)>& edit) {
  state_->stepper.changes.add(edit);
}

void HapticLoop::tick() noexcept {
  state_->tick();
}

// The servo first, so that nobody ticks any more; then who might write; then zeros.
void HapticLoop::stop() noexcept {
  State& s = *state_;
  if (s.running) {
    if (s.driving) s.driving->stop_servo();
    s.servo.stop();
    s.watchdog.stop();
    s.body->stop();
    s.stepper.changes.close();
    while (s.stepper.make_change()) {
    }
  }
  for (haptics::HandChannel& hand : s.hands) hand.release();
  s.stepper.resume();
  s.report();
  s.last_begin = 0;
  s.running = false;
}

bool HapticLoop::running() const noexcept {
  return state_->running;
}

LoopStatus HapticLoop::status() const noexcept {
  return state_->published.load();
}

LoopTimes HapticLoop::times() const noexcept {
  const State& s = *state_;
  return {percentiles(s.wall), percentiles(s.servo.cpu()), percentiles(s.servo.lateness()), percentiles(s.period),
          s.rate.load(std::memory_order_relaxed)};
}

std::string HapticLoop::realtime() const {
  return state_->servo.scheduling();
}

void HapticLoop::halt() noexcept {
  for (haptics::HandRequests& requests : state_->requests) requests.fault = Fault::halted;
}

void HapticLoop::reset_fault(std::size_t hand) noexcept {
  if (hand < state_->hands.size()) state_->requests[hand].reset = true;
}

const char* to_string(HandState state) noexcept {
  switch (state) {
    case HandState::waiting:
      return "waiting";
    case HandState::ramping:
      return "ramping";
    case HandState::running:
      return "running";
    case HandState::clutched:
      return "clutched";
    case HandState::faulted:
      return "faulted";
  }
  return "unknown";
}

}  // namespace crumble
