// Golden hashes of a haptic loop and of its replay: forces, events and state have the same bits from every build, live,
// played by the clock of the ticks, and played row by row.
#include <gtest/gtest.h>

#include <array>
#include <cinttypes>
#include <cstdio>

#include "crumble/base/hash.hpp"
#include "crumble/device/hand.hpp"
#include "crumble/device/recorder.hpp"
#include "crumble/device/replay.hpp"
#include "crumble/haptics/loop.hpp"
#include "crumble/sim/publisher.hpp"
#include "crumble/tetmesh/lattice_box.hpp"

namespace crumble {
namespace {

constexpr std::size_t kTicks = 2000;

struct Outcome {
  std::uint64_t forces, events, state;
  std::uint64_t cuts;
  bool operator==(const Outcome&) const = default;
};
void PrintTo(const Outcome& o, std::ostream* out) {
  char line[120];
  std::snprintf(line, sizeof line, "{0x%016" PRIx64 ", 0x%016" PRIx64 ", 0x%016" PRIx64 ", %" PRIu64 "}", o.forces,
                o.events, o.state, o.cuts);
  *out << line;
}

constexpr Outcome kExpected{0xff32ccafe0bac1f9, 0x320b798897d8e1c3, 0x1f4685742cd1bf7e, 20};

// Small: builds without optimisation take half a minute for a second of the paper's cube.
SimulationDef small_cube() {
  SimulationDef def;
  def.mesh = make_lattice_box({0.03, 0.03, 0.03}, 0.006);
  def.fixed_nodes = nodes_below(def.mesh, 1e-6);
  def.gravity = Vec3::Zero();
  def.walls.clear();
  def.tools = {{make_round_stick(0.004, 0.05, 16), {0.5, 0.5}}};
  return def;
}

// Firm enough to break the cube, through encoders, aslant.
std::unique_ptr<Device> breaking_hand() {
  HandOptions hand;
  hand.start.position.y() = 0.001;
  hand.points = {{.time = 0.8}, {.time = 1.9, .move = {0.004, -0.022, 0.001}}, {.time = 10, .move = {0, 0, 0}}};
  hand.mass = 0.25, hand.stiffness = 500, hand.damping = 5, hand.friction = 0.05;
  hand.encoder_step = 5.5e-5;
  hand.delay = 1;
  return open_hand(hand, 1e-3);
}

void add(StatePublisher& publisher, Hash& hash) {
  std::array<Event, 128> events;
  while (const std::size_t count = publisher.read_events(events)) {
    for (std::size_t i = 0; i < count; ++i) {
      const Event& e = events[i];
      hash.add(std::uint64_t{static_cast<std::uint32_t>(e.kind)}), hash.add(e.step), hash.add(e.time);
      hash.add(std::uint64_t{e.spring}), hash.add(std::uint64_t{e.node}), hash.add(std::uint64_t{e.fragment});
      hash.add(e.place.x()), hash.add(e.place.y()), hash.add(e.place.z()), hash.add(e.energy);
    }
  }
}

Outcome run(Recorder& device) {
  Simulation sim(small_cube());
  LoopDef def;
  def.driver = LoopDriver::host;
  HandDef hand;
  hand.device = &device;
  hand.workspace.pose.position = {0, 0.034, 0};
  hand.passivity.controller = true;
  def.hands = {hand};
  HapticLoop loop(sim, def);
  StatePublisher publisher(sim);
  loop.publish_to(publisher);
  Hash forces, events;
  for (std::size_t tick = 0; tick < kTicks; ++tick) {
    loop.tick();
    const Vec3 force = loop.status().hands[0].force;
    forces.add(force.x()), forces.add(force.y()), forces.add(force.z());
    add(publisher, events);
  }
  EXPECT_EQ(loop.status().hands[0].fault, Fault::none);
  EXPECT_EQ(publisher.events_dropped(), 0u);
  return {forces.value(), events.value(), sim.state_hash(), sim.counters().cuts};
}

TEST(LoopGolden, SameBitsInEveryBuildLiveAndReplayed) {
  Recorder live(breaking_hand(), kTicks);
  const Outcome outcome = run(live);
  EXPECT_GT(outcome.cuts, 10u) << "a run in which little happens would prove little";
  EXPECT_EQ(outcome, kExpected);
  const Trajectory recorded = parse_trajectory(format_trajectory(live.trajectory()), "recorded");
  for (const ReplayClock clock : {ReplayClock::step_locked, ReplayClock::fast}) {
    Recorder again(open_replay(recorded, {.clock = clock}, 1e-3), kTicks);
    EXPECT_EQ(run(again), kExpected);
  }
}

}  // namespace
}  // namespace crumble
