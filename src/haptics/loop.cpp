#include "crumble/haptics/loop.hpp"

#include <algorithm>
#include <cmath>

#include "crumble/base/clock.hpp"
#include "crumble/base/text.hpp"
#include "haptics/loop_state.hpp"

namespace crumble {
namespace {

constexpr double kLeastTick = 1e-4, kMostTick = 0.01;
constexpr double kWatchPeriod = 2e-3;
constexpr double kStartTime = 1;  // s that a device may take to its first tick
constexpr std::uint32_t kMostBodyTicks = 100;

bool is_direct(const LoopDef& def) {
  return def.coupling == BodyCoupling::direct;
}

// Ticks over which the force is a mean or held.
double mean_of(const Simulation& sim, const LoopDef& def) {
  constexpr double kMean = 5;  // Eq (7)
  switch (def.coupling) {
    case BodyCoupling::direct:
      return sim.definition().step.mean_force ? kMean : 1;
    case BodyCoupling::local_model:
      return 1;
    case BodyCoupling::paper:
      return kMean * def.body_ticks;
  }
  return 1;
}

double body_step(const LoopDef& def) {
  return def.tick * def.body_ticks;
}

void check_times(const Simulation& sim, const LoopDef& def) {
  require_finite("tick", def.tick);
  require_in_range("tick", def.tick, kLeastTick, kMostTick);
  require_in_range("body_ticks", def.body_ticks, 1, is_direct(def) ? 1 : kMostBodyTicks);
  if (is_direct(def) && def.body_thread) {
    throw Error(Code::state, "body_thread needs coupling local_model or paper: a direct tick steps the body itself");
  }
  const StepSettings& step = sim.definition().step;
  const double tau = step.tau * step.iterations;
  if (std::abs(tau - body_step(def)) > 1e-9 * tau) {
    throw Error(Code::out_of_range, "tick * body_ticks is " + to_text(body_step(def)) +
                                        " s, but a step of the simulation advances " + to_text(tau) +
                                        " s: time would not be the hand's");
  }
}

void check_hands(const Simulation& sim, const LoopDef& def) {
  if (def.hands.empty()) throw Error(Code::empty, "hands is empty");
  if (def.hands.size() > kMaxHands) {
    throw Error(Code::too_large, "hands has " + std::to_string(def.hands.size()) + " entries, at most " +
                                     std::to_string(kMaxHands) + " are allowed");
  }
  for (std::size_t i = 0; i < def.hands.size(); ++i) {
    const HandDef& hand = def.hands[i];
    const std::string name = "hands[" + std::to_string(i) + "]";
    if (!hand.device) throw Error(Code::null, name + ".device is null");
    if (hand.holder >= sim.holder_count()) {
      throw Error(Code::out_of_range, name + ".holder is " + std::to_string(hand.holder) + ", the simulation has " +
                                          std::to_string(sim.holder_count()));
    }
    for (std::size_t j = 0; j < i; ++j) {
      if (def.hands[j].holder == hand.holder || def.hands[j].device == hand.device) {
        throw Error(Code::state, name + " has the holder or the device of hands[" + std::to_string(j) + "]");
      }
    }
    try {
      check(hand.coupling), check(hand.passivity), check(hand.safety);
      static_cast<void>(Workspace(hand.workspace));
    } catch (const Error& error) {
      throw Error(error.code(), name + "." + error.what());
    }
  }
}

std::vector<std::uint32_t> holders_of(const LoopDef& def) {
  std::vector<std::uint32_t> holders;
  for (const HandDef& hand : def.hands) holders.push_back(hand.holder);
  return holders;
}

// Time in the loop goes by the tick's length, whoever calls it.
void require_same_rate(const LoopDef& def, const DeviceInfo& info) {
  constexpr double kSame = 0.01;
  if (info.rate <= 0 || std::abs(info.rate * def.tick - 1) <= kSame) return;
  throw Error(Code::out_of_range, "tick is " + to_text(def.tick) + " s, but '" + info.name + "' ticks at " +
                                      to_text(info.rate) + " Hz, which makes " + to_text(1 / info.rate) + " s");
}

Device* driving_device(const LoopDef& def) {
  if (def.driver == LoopDriver::own_thread || def.driver == LoopDriver::host) return nullptr;
  for (const HandDef& hand : def.hands) {
    const DeviceInfo& info = hand.device->info();
    if (!info.servo_driven) continue;
    require_same_rate(def, info);
    return hand.device;
  }
  if (def.driver == LoopDriver::automatic) return nullptr;
  throw Error(Code::unsupported, "driver is device, but none of the devices has a thread of its own");
}

bool needs_polling(const Device& device, const Device* driving) {
  const DeviceInfo& info = device.info();
  if (!info.servo_driven || &device == driving) return false;
  return !driving || !info.servo_group || info.servo_group != driving->info().servo_group;
}

// The exchange makes a force a tick late.
LoopDef with_polled(LoopDef def, const Device* driving, std::deque<PolledDevice>& polled) {
  for (HandDef& hand : def.hands) {
    if (!needs_polling(*hand.device, driving)) continue;
    hand.device = &polled.emplace_back(*hand.device);
    hand.passivity.delay = std::min(hand.passivity.delay + 1, kMostDelay);
  }
  return def;
}

// What a spring that one knows beforehand will ask for.
std::vector<std::string> find_warnings(const LoopDef& def) {
  std::vector<std::string> warnings;
  for (std::size_t i = 0; i < def.hands.size(); ++i) {
    const HandDef& hand = def.hands[i];
    const DeviceInfo& info = hand.device->info();
    const std::string name = "hands[" + std::to_string(i) + "]: ";
    if (!hand.coupling.enabled) {
      warnings.push_back(name +
                         "without the virtual coupling the stiffness grows with the contact; see "
                         "HandEnergy::required_damping for what it takes");
      continue;
    }
    const double stiffness =
        hand.coupling.stiffness > 0 ? hand.coupling.stiffness : safe_stiffness(info, hand.passivity, def.tick);
    const double needed = stiffness * def.tick * (0.5 + hand.passivity.delay) - info.friction_damping;
    const double limit = hand.passivity.inject_damping ? damping_limit(hand.passivity, info, def.tick) : 0;
    if (needed > limit * (1 + 1e-9)) {
      warnings.push_back(name + "coupling.stiffness " + to_text(stiffness) + " N/m needs " + to_text(needed) +
                         " N s/m of damping, " + to_text(limit) + " are to be had: the loop may ring");
    }
  }
  return warnings;
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
    : driving((check_times(simulation, definition), check_hands(simulation, definition), driving_device(definition))),
      def(with_polled(std::move(definition), driving, polled)),
      warnings(find_warnings(def)),
      sim(simulation),
      stepper(simulation, holders_of(def)),
      body(is_direct(def) ? haptics::make_direct_link(stepper) : haptics::make_model_link(stepper, def)),
      poses(simulation.holder_count()),
      moved_by_hand(simulation.holder_count(), 0) {
  for (const HandDef& hand : def.hands) {
    hands.emplace_back(hand, def.tick, mean_of(sim, def), 2 * body_step(def));
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

const std::vector<std::string>& HapticLoop::warnings() const noexcept {
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
