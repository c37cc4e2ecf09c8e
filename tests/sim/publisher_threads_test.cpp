// A thread that steps at 1 kHz and one that draws at 60 Hz. scripts/verify-publisher runs this for a minute under
// ThreadSanitizer.
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdlib>
#include <string>
#include <thread>

#include "crumble/base/memory.hpp"
#include "crumble/fracture/surface.hpp"
#include "crumble/sim/publisher.hpp"
#include "sim/press_rig.hpp"

namespace crumble {
namespace {

using Clock = std::chrono::steady_clock;

constexpr std::uint64_t kPressSteps = 1800;  // 18 mm into the cube; then it is whole again

// CRUMBLE_TEST_SECONDS: how long the threads run, 2 s without it.
std::chrono::duration<double> test_time() {
  const char* seconds = std::getenv("CRUMBLE_TEST_SECONDS");
  return std::chrono::duration<double>(seconds ? std::stod(seconds) : 2);
}

// What one thread alone finds in each step of the press.
struct Reference {
  Vector<VecArray> positions;
  Vector<Vector<std::uint8_t>> intact;
  Vector<Vector<std::uint32_t>> fragments;

  explicit Reference(PressRig rig) {
    for (std::uint64_t step = 0; step <= kPressSteps; ++step, rig.press()) {
      positions.emplace_back(rig.sim.mesh().node_count());
      rig.sim.read_positions(0, positions.back());
      intact.emplace_back(rig.sim.intact().begin(), rig.sim.intact().end());
      fragments.emplace_back(rig.sim.node_fragments().begin(), rig.sim.node_fragments().end());
    }
  }
  bool has(const PublishedState& state) const {
    const VecArray& p = positions[state.step];
    return state.positions.x == p.x && state.positions.y == p.y && state.positions.z == p.z &&
           state.intact == intact[state.step] && state.fragments == fragments[state.step];
  }
};

TEST(Publisher, AThreadAtSixtyHertzSeesWholeStepsOfAThreadAtOneKilohertz) {
  PressRig rig("tofu_cube", Preset::standard, 0.01);
  const Reference reference(rig);
  SurfaceExtractor surface(rig.sim.mesh());
  StatePublisher publisher(rig.sim);
  std::atomic<bool> done{false}, seen_enough{false};  // however the threads are scheduled
  std::uint64_t events_made = 0, rounds = 0;
  const Vector<std::uint8_t> start = rig.sim.snapshot();

  std::thread stepper([&] {
    const Clock::time_point end = Clock::now() + std::chrono::duration_cast<Clock::duration>(test_time());
    for (Clock::time_point next = Clock::now(); next < end || !seen_enough; next += std::chrono::milliseconds(1)) {
      std::this_thread::sleep_until(next);
      if (rig.sim.info().step == kPressSteps) {
        if (rounds++ % 2 == 0) {
          rig.sim.restore(start);
        } else {
          rig.sim.reset();
        }
        publisher.publish_now(rig.sim);
      }
      rig.press();
      publisher.publish(rig.sim);
      events_made += rig.sim.events().size();
    }
    done.store(true);
  });

  std::uint64_t states = 0, wrong = 0, last = 0, events_seen = 0, most_triangles = 0;
  Vector<Event> events(1000);
  for (bool was_done = false; !was_done;) {
    was_done = done.load();
    std::this_thread::sleep_for(std::chrono::microseconds(16667));
    const PublishedState& state = publisher.latest();
    surface.update({state.positions, state.intact, state.fragments, state.time});
    wrong += !reference.has(state);
    states += state.step != last;
    last = state.step;
    most_triangles = std::max<std::uint64_t>(most_triangles, surface.triangles().size());
    seen_enough = states > 20 && most_triangles > rig.sim.mesh().boundary.size();  // it did break
    for (std::size_t count = events.size(); count == events.size(); events_seen += count) {
      count = publisher.read_events(events);
    }
  }
  stepper.join();
  EXPECT_EQ(wrong, 0u);
  EXPECT_EQ(events_seen + publisher.events_dropped(), events_made);
  RecordProperty("states", std::to_string(states));
}

}  // namespace
}  // namespace crumble
