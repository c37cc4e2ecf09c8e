#include "loop_replay.hpp"

#include <array>

#include "crumble/base/hash.hpp"
#include "crumble/base/text.hpp"
#include "crumble/device/recorder.hpp"
#include "loop_report.hpp"
#include "output.hpp"

namespace crumble::app {
namespace {

void add(const Event& event, Hash& hash) {
  for (const std::uint32_t part :
       {static_cast<std::uint32_t>(event.kind), event.spring, event.node, event.holder, event.fragment, event.parent}) {
    hash.add(std::uint64_t{part});
  }
  hash.add(event.step);
  for (const double part : {event.time, event.place.x(), event.place.y(), event.place.z(), event.energy})
    hash.add(part);
}

void read_events(StatePublisher& publisher, LoopReplay& out, Hash& hash) {
  std::array<Event, 256> events;
  while (const std::size_t count = publisher.read_events(events)) {
    for (std::size_t i = 0; i < count; ++i) add(events[i], hash);
    out.events += count;
  }
}

bool same(const Vec3& a, const Vec3& b) {
  return a.x() == b.x() && a.y() == b.y() && a.z() == b.z();
}

std::string settings_text(const std::string& scene, const LoopSettings& s) {
  return scene + ", " + to_string(s.coupling) + ", " + std::to_string(s.body_ticks) + " ticks a step, " +
         to_text(s.device.rate) + " Hz, coupling " + (s.virtual_coupling ? "on" : "off") + ", damping " +
         (s.damping ? "on" : "off") + ", controller " + (s.controller ? "on" : "off");
}

[[noreturn]] void differ(const std::string& what) {
  throw Error(Code::diverged, "the loop run again is another one: " + what);
}

}  // namespace

LoopReplay replay_loop(Scene scene, const LoopSettings& settings, const Trajectory& trajectory) {
  if (settings.body_thread) throw Error(Code::state, "a loop with --body-thread cannot be repeated");
  const double tick = 1 / settings.device.rate;
  Recorder recorder(open_replay(trajectory, {.clock = ReplayClock::fast}, tick), trajectory.rows.size());
  scene.def.step.tau = settings.body_ticks * tick / scene.def.step.iterations;
  Simulation sim(std::move(scene.def));
  LoopDef def = loop_def(settings, scene.motions[0].start, recorder);
  def.driver = LoopDriver::host;
  HapticLoop loop(sim, def);
  for (std::size_t i = 1; i < scene.motions.size(); ++i) loop.place(i, scene.motions[i].start);
  StatePublisher publisher(sim);
  loop.publish_to(publisher);

  LoopReplay out;
  out.rows = trajectory.rows.size();
  Hash events;
  for (std::size_t row = 0; row < out.rows; ++row) {
    loop.tick();
    read_events(publisher, out, events);
  }
  out.event_hash = events.value();
  out.state_hash = sim.state_hash();
  const Trajectory again = recorder.trajectory();
  for (std::size_t row = 0; row < out.rows && !out.first_difference; ++row) {
    if (row >= again.rows.size() || !same(again.rows[row].force, trajectory.rows[row].force))
      out.first_difference = row;
  }
  return out;
}

void add_loop_lines(const std::string& scene, const LoopSettings& settings, const LoopReplay& replay,
                    Trajectory& trajectory) {
  trajectory.header.push_back("loop: " + settings_text(scene, settings));
  trajectory.header.push_back("loop_delay: " + to_text(settings.delay));
  trajectory.header.push_back("loop_events: " + std::to_string(replay.events) + " " + hash_text(replay.event_hash));
  trajectory.header.push_back("loop_state: " + hash_text(replay.state_hash));
}

LoopReplay verify_loop(Scene scene, LoopSettings settings, const Trajectory& trajectory) {
  const std::string_view loop = trajectory.value_of("loop");
  const auto delay = parse_double(trajectory.value_of("loop_delay"));
  if (loop.empty() || !delay) {
    throw Error(Code::state, "--verify: the trajectory was not recorded by `crumble loop --record`");
  }
  if (const std::string now = settings_text(scene.name, settings); loop != now) {
    throw Error(Code::state, "--verify: it was recorded with '" + std::string(loop) + "', not with '" + now + "'");
  }
  settings.delay = *delay;
  const LoopReplay replay = replay_loop(std::move(scene), settings, trajectory);
  if (replay.first_difference) differ("the force of row " + std::to_string(*replay.first_difference));
  const std::string events = std::to_string(replay.events) + " " + hash_text(replay.event_hash);
  if (trajectory.value_of("loop_events") != events) differ("the events are " + events);
  if (trajectory.value_of("loop_state") != hash_text(replay.state_hash)) {
    differ("the state's hash is " + hash_text(replay.state_hash));
  }
  return replay;
}

}  // namespace crumble::app
