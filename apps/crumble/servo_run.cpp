#include "servo_run.hpp"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <thread>

#include "crumble/base/text.hpp"
#include "crumble/device/recorder.hpp"

namespace crumble::app {
namespace {

constexpr double kClearance = 1e-3, kMostDepth = 6e-3;  // m: above the tool's start, and how deep the hand presses
constexpr double kWait = 0.8;                        // s: the loop lets nothing in before, and the force comes slowly
constexpr double kMove = 1, kHold = 2, kRest = 0.2;  // s, of the hand
constexpr auto kLook = std::chrono::milliseconds(1);
constexpr std::string_view kPress = "press:", kReplay = "replay:";

struct OpenDevice {
  std::unique_ptr<Device> device;
  double seconds;  // of its motion
};

OpenDevice open_hand(const Scene& scene, const LoopSettings& settings) {
  const Vec3 deep{0, -(kClearance + std::min(kMostDepth, scene.motions[0].press.depth)), 0};
  HandOptions hand;
  hand.start.position.y() = kClearance;
  hand.points = {{kWait, Vec3::Zero()},
                 {kWait + kMove, deep},
                 {kWait + kMove + kHold, deep},
                 {kWait + kMove + kHold + kMove, Vec3::Zero()}};
  hand.encoder_step = settings.encoder_step;
  return {crumble::open_hand(hand, 1 / settings.rate), hand.points.back().time + kRest};
}

// m/s
double press_speed(const std::string& device) {
  const auto speed = parse_double(std::string_view(device).substr(kPress.size()));
  if (!speed) throw Error(Code::format, "--device '" + device + "': press:MM_PER_S takes a number");
  require_positive("--device press:MM_PER_S", *speed);
  return *speed * 1e-3;
}

OpenDevice open_press(const Scene& scene, const LoopSettings& settings) {
  const double way = kClearance + scene.motions[0].press.depth;
  const double seconds = kWait + way / press_speed(settings.device);
  const Pose start{{0, kClearance, 0}, Quat::Identity()};
  return {open_path({start, {{kWait, Vec3::Zero()}, {seconds, {0, -way, 0}}}}, 1 / settings.rate), seconds};
}

OpenDevice open_replay(const LoopSettings& settings) {
  const Trajectory trajectory = load_trajectory(settings.device.substr(kReplay.size()));
  const double seconds = trajectory.rows.back().time - trajectory.rows.front().time;
  return {crumble::open_replay(trajectory, {}, 1 / settings.rate), seconds};
}

OpenDevice open_named(const Scene& scene, const LoopSettings& settings) {
  OpenDevice open = settings.device == "hand"             ? open_hand(scene, settings)
                    : settings.device.starts_with(kPress) ? open_press(scene, settings)
                                                          : open_replay(settings);
  if (!(open.seconds <= kMostLoopSeconds) && !settings.seconds) {
    throw Error(Code::too_large, "--device '" + settings.device + "' takes " + to_text(open.seconds) +
                                     " s, a loop runs at most " + to_text(kMostLoopSeconds) + " s; see --seconds");
  }
  return open;
}

LoopDef loop_def(const LoopSettings& settings, const Pose& start, Device& device) {
  LoopDef def;
  def.tick = 1 / settings.rate;
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
  hand.passivity.delay = 0;  // none of these devices has one
  def.hands = {hand};
  return def;
}

// Keeps what the loop tells.
class Watcher {
 public:
  Watcher(HapticLoop& loop, StatePublisher& publisher, LoopRun& run) : loop_(loop), publisher_(publisher), run_(run) {}

  /// Until the loop has ticked so often.
  void watch(std::uint64_t ticks) {
    std::uint64_t seen = 0;
    while (seen < ticks) {
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
  Watcher(loop, publisher, out).watch(static_cast<std::uint64_t>(std::ceil(out.seconds * out.settings.rate)));
  loop.stop();
  out.status = loop.status();
  out.state = out.samples.back().state;
  out.times = loop.times();
  out.cuts = sim.counters().cuts;
}

}  // namespace

void check(const LoopSettings& s) {
  const bool direct = s.coupling == BodyCoupling::direct;
  require_finite("--rate", s.rate);
  require_in_range("--rate", s.rate, 100, 10'000);
  require_in_range("--body-ticks", s.body_ticks, 1, 100);
  if (direct && s.body_ticks != 1) {
    throw Error(Code::state, "--body-ticks " + std::to_string(s.body_ticks) + " needs --coupling local_model or paper");
  }
  if (direct && s.body_thread) throw Error(Code::state, "--body-thread needs --coupling local_model or paper");
  if (s.body_ticks / s.rate > kMaxTimeStep * (1 + 1e-9)) {
    throw Error(Code::out_of_range, "--body-ticks " + std::to_string(s.body_ticks) + " at --rate " + to_text(s.rate) +
                                        " make a step of " + to_text(s.body_ticks / s.rate) + " s, the body takes " +
                                        to_text(kMaxTimeStep) + " s at most");
  }
  if (s.seconds) {
    require_positive("--seconds", *s.seconds);
    require_in_range("--seconds", *s.seconds, 0, kMostLoopSeconds);
  }
  if (s.device != "hand" && s.encoder_step != 0) {
    throw Error(Code::state, "--encoder needs --device hand, which is '" + s.device + "'");
  }
  if (s.device.starts_with(kPress)) press_speed(s.device);
  if (s.device != "hand" && !s.device.starts_with(kPress) && !s.device.starts_with(kReplay)) {
    throw Error(Code::unsupported,
                "--device '" + s.device + "' is not known; there are hand, press:MM_PER_S and replay:FILE");
  }
}

LoopRun run_loop(Scene scene, const LoopSettings& settings) {
  OpenDevice open = open_named(scene, settings);
  LoopRun out;
  out.scene = scene.name;
  out.device = open.device->info().name;
  out.settings = settings;
  out.seconds = settings.seconds.value_or(open.seconds);
  Recorder* recorder = nullptr;
  if (settings.record) {
    // a loop that is late to be stopped ticks on a little
    const auto capacity = static_cast<std::size_t>((out.seconds + 1) * settings.rate) + 1;
    auto recording = std::make_unique<Recorder>(std::move(open.device), capacity);
    recorder = recording.get();
    open.device = std::move(recording);
  }
  scene.def.step.tau = settings.body_ticks / settings.rate / scene.def.step.iterations;
  Simulation sim(std::move(scene.def));
  HapticLoop loop(sim, loop_def(settings, scene.motions[0].start, *open.device));
  for (std::size_t i = 1; i < scene.motions.size(); ++i) loop.place(i, scene.motions[i].start);
  run(loop, sim, out);
  if (recorder) out.trajectory = recorder->trajectory();
  return out;
}

}  // namespace crumble::app
