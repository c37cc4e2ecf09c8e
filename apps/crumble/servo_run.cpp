#include "servo_run.hpp"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <thread>

#include "crumble/base/clock.hpp"
#include "crumble/base/text.hpp"
#include "crumble/device/recorder.hpp"

namespace crumble::app {
namespace {

constexpr auto kLook = std::chrono::milliseconds(1);
constexpr double kPatience = 5;  // s: a device that has stopped calling does not keep us for ever

// Where the scene's tool starts it touches the body.
NamedDevice open_over(const Scene& scene, LoopSettings& settings) {
  settings.device.depth = scene.motions[0].press.depth;
  NamedDevice open = open_named(settings.device);
  if (settings.seconds) return open;
  const std::string device = "--device '" + settings.device.name + "' ";
  if (!open.seconds) throw Error(Code::empty, device + "has no end of its own: give --seconds");
  if (!(*open.seconds <= kMostLoopSeconds)) {
    throw Error(Code::too_large, device + "takes " + to_text(*open.seconds) + " s, a loop runs at most " +
                                     to_text(kMostLoopSeconds) + " s; see --seconds");
  }
  return open;
}

// Keeps what the loop tells.
class Watcher {
 public:
  Watcher(HapticLoop& loop, StatePublisher& publisher, LoopRun& run) : loop_(loop), publisher_(publisher), run_(run) {}

  /// Until the loop has ticked so often.
  void watch(std::uint64_t ticks, double seconds) {
    std::uint64_t seen = 0;
    const double end = wall_seconds() + 3 * seconds + kPatience;
    while (seen < ticks && wall_seconds() < end) {
      std::this_thread::sleep_for(kLook);
      const LoopStatus status = loop_.status();
      if (status.ticks == seen) continue;
      seen = status.ticks;
      count_cuts();
      add(status.hands[0]);
    }
  }

 private:
  void count_cuts() {
    std::array<Event, 256> events;
    while (const std::size_t count = publisher_.read_events(events)) {
      run_.cuts +=
          static_cast<std::uint64_t>(std::count_if(events.begin(), events.begin() + static_cast<std::ptrdiff_t>(count),
                                                   [](const Event& event) { return event.kind == EventKind::cut; }));
    }
  }
  void add(const HandStatus& hand) {
    run_.samples.push_back(
        {hand.time, hand.device, hand.force, hand.tool.position, hand.contacts, run_.cuts, hand.state});
    run_.peak_force = std::max(run_.peak_force, norm(hand.force));
    run_.stiffness = std::max(run_.stiffness, hand.stiffness);
    run_.damping = std::max(run_.damping, hand.damping);
  }

  HapticLoop& loop_;
  StatePublisher& publisher_;
  LoopRun& run_;
};

void run(HapticLoop& loop, Simulation& sim, LoopRun& out) {
  StatePublisher publisher(sim);
  loop.publish_to(publisher);
  out.warnings = loop.warnings();
  out.samples.reserve(static_cast<std::size_t>(1e3 * out.seconds) + 1);
  loop.start();
  out.scheduling = loop.realtime();
  Watcher(loop, publisher, out)
      .watch(static_cast<std::uint64_t>(std::ceil(out.seconds * out.settings.device.rate)), out.seconds);
  loop.stop();
  out.status = loop.status();
  if (!out.samples.empty()) out.state = out.samples.back().state;
  out.times = loop.times();
  out.cuts = sim.counters().cuts;
}

}  // namespace

LoopDef loop_def(const LoopSettings& settings, const Pose& start, Device& device) {
  LoopDef def;
  def.tick = 1 / settings.device.rate;
  def.coupling = settings.coupling;
  def.body_ticks = settings.body_ticks;
  def.body_thread = settings.body_thread;
  HandDef hand;
  hand.device = &device;
  hand.workspace.pose.position = start.position;
  hand.workspace.mount = start.orientation;
  hand.coupling.enabled = settings.virtual_coupling;
  hand.passivity.inject_damping = settings.damping;
  hand.passivity.controller = settings.controller;
  hand.passivity.delay = settings.delay;
  def.hands = {hand};
  return def;
}

void check(const LoopSettings& s) {
  const bool direct = s.coupling == BodyCoupling::direct;
  check(s.device);
  require_in_range("--body-ticks", s.body_ticks, 1, 100);
  if (direct && s.body_ticks != 1) {
    throw Error(Code::state, "--body-ticks " + std::to_string(s.body_ticks) + " needs --coupling local_model or paper");
  }
  if (direct && s.body_thread) throw Error(Code::state, "--body-thread needs --coupling local_model or paper");
  if (s.body_ticks / s.device.rate > kMaxTimeStep * (1 + 1e-9)) {
    throw Error(Code::out_of_range, "--body-ticks " + std::to_string(s.body_ticks) + " at --rate " +
                                        to_text(s.device.rate) + " make a step of " +
                                        to_text(s.body_ticks / s.device.rate) + " s, the body takes " +
                                        to_text(kMaxTimeStep) + " s at most");
  }
  if (s.seconds) {
    require_positive("--seconds", *s.seconds);
    require_in_range("--seconds", *s.seconds, 0, kMostLoopSeconds);
  }
}

LoopRun run_loop(Scene scene, LoopSettings settings) {
  NamedDevice open = open_over(scene, settings);
  // Simulated devices have none
  settings.delay = open.device->info().step_locked ? 0 : PassivityOptions().delay;
  LoopRun out;
  out.scene = scene.name;
  out.device = open.device->info().name;
  out.settings = settings;
  out.seconds = settings.seconds.value_or(open.seconds.value_or(0));
  Recorder* recorder = nullptr;
  if (settings.record) {
    // a loop that is late to be stopped ticks on a little
    const auto capacity = static_cast<std::size_t>((out.seconds + 1) * settings.device.rate) + 1;
    auto recording = std::make_unique<Recorder>(std::move(open.device), capacity);
    recorder = recording.get();
    open.device = std::move(recording);
  }
  scene.def.step.tau = settings.body_ticks / settings.device.rate / scene.def.step.iterations;
  Simulation sim(std::move(scene.def));
  HapticLoop loop(sim, loop_def(settings, scene.motions[0].start, *open.device));
  for (std::size_t i = 1; i < scene.motions.size(); ++i) loop.place(i, scene.motions[i].start);
  out.device_drove = open.device->info().servo_driven;
  run(loop, sim, out);
  out.device_text = open.device->error_text();
  if (recorder) out.trajectory = recorder->trajectory();
  return out;
}

}  // namespace crumble::app
