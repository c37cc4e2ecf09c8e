#include "crumble/sim/publisher.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "crumble/base/memory.hpp"
#include "crumble/tetmesh/lattice_box.hpp"
#include "sim/press_rig.hpp"
#include "support/allocation_counter.hpp"

namespace crumble {
namespace {

template <class T>
bool equal(std::span<const T> a, std::span<const T> b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end());
}

// All of `state` is what `sim` is now, to the bit.
::testing::AssertionResult is_state_of(const Simulation& sim, const PublishedState& state) {
  const VecView now = sim.positions(), seen = state.positions;
  if (state.first_step != sim.info().step || state.step != sim.info().step || state.time != sim.info().time) {
    return ::testing::AssertionFailure() << "steps " << state.first_step << " to " << state.step << " for "
                                         << sim.info().step;
  }
  if (!equal(now.x, seen.x) || !equal(now.y, seen.y) || !equal(now.z, seen.z)) {
    return ::testing::AssertionFailure() << "positions differ at step " << state.step;
  }
  if (!equal<std::uint8_t>(sim.intact(), state.intact)) return ::testing::AssertionFailure() << "cuts differ";
  if (!equal<std::uint32_t>(sim.node_fragments(), state.fragments)) {
    return ::testing::AssertionFailure() << "fragments differ";
  }
  if (sim.counters().cuts != state.counters.cuts) return ::testing::AssertionFailure() << "counters differ";
  if (sim.fragments().count() != state.fragment_count) return ::testing::AssertionFailure() << "fragment counts differ";
  for (std::uint32_t f = 0; f < state.fragment_count; ++f) {
    const FragmentRecord &now_known = sim.fragments().record(f), &known = state.records[f];
    if (now_known.parent != known.parent || now_known.node_count != known.node_count || now_known.born != known.born ||
        sim.fragment_state(f) != state.fragment_states[f]) {
      return ::testing::AssertionFailure() << "records of fragment " << f << " differ";
    }
  }
  return ::testing::AssertionSuccess();
}

TEST(Publisher, AStateOfASmallBodyIsThatOfOneStepToTheBit) {
  PressRig rig("tofu_cube", Preset::standard, 0.02);
  rig.press_to(0.003);
  StatePublisher publisher(rig.sim);
  EXPECT_TRUE(is_state_of(rig.sim, publisher.latest()));
  std::uint64_t last = rig.sim.info().step;
  int states = 0;
  while (rig.speed * rig.sim.info().time < 0.02) {
    rig.press();
    publisher.publish(rig.sim);
    const PublishedState& state = publisher.latest();
    if (state.step == last) continue;
    last = state.step;
    ++states;
    ASSERT_TRUE(is_state_of(rig.sim, state));
  }
  EXPECT_GT(states, 40);
  EXPECT_GT(publisher.latest().counters.cuts, 100u);
}

TEST(Publisher, CopiesNothingUnlessAskedAndThenOnce) {
  PressRig rig;
  StatePublisher publisher(rig.sim);
  const auto steps = [&](int count) {
    for (int i = 0; i < count; ++i) rig.press(), publisher.publish(rig.sim);
  };
  steps(100);
  EXPECT_EQ(publisher.latest().step, 0u);  // nobody had asked before
  steps(100);
  EXPECT_EQ(publisher.latest().step, 101u);
  steps(100);
  EXPECT_EQ(publisher.latest().step, 201u);
}

TEST(Publisher, CopiesNoMoreThanSixtyStatesInASimulatedSecond) {
  for (const double tau : {1e-3, 2.9e-3}) {
    PressRig rig;
    rig.scene.def.step.tau = tau;
    rig.sim = Simulation(rig.scene.def);
    StatePublisher publisher(rig.sim);
    int states = 0;
    for (std::uint64_t last = 0; rig.sim.info().time < 2;) {
      rig.press();
      publisher.publish(rig.sim);
      const std::uint64_t step = publisher.latest().step;
      states += step != last;
      last = step;
    }
    EXPECT_LE(states, 120) << tau;
    EXPECT_GE(states, 118) << tau;
  }
}

// 29 791 nodes in sixteen slices, under a weight that tears it.
SimulationDef torn_box() {
  SimulationDef def;
  def.mesh = make_lattice_box({0.03, 0.03, 0.03}, 0.001);
  def.material.length_limit = 1.001;
  def.walls.clear();
  def.gravity = {0, -300, 0};
  for (std::uint32_t i = 0; i < def.mesh.node_count(); ++i) {
    if (def.mesh.positions[i].y() > 0.0299) def.fixed_nodes.push_back(i);
  }
  return def;
}
constexpr std::size_t kSlices = 16;

TEST(Publisher, ALargeBodyIsCopiedInSlicesEachOfOneStep) {
  Simulation sim(torn_box());
  const std::size_t nodes = sim.mesh().node_count(), springs = sim.network().spring_count();
  StatePublisher publisher(sim);
  publisher.latest();
  Vector<PublishedState> past;  // by step, whole
  const auto step = [&] {
    sim.step({});
    publisher.publish(sim);
    PublishedState& state = past.emplace_back();
    state.positions = VecArray(nodes);
    sim.read_positions(0, state.positions);
    state.intact.assign(sim.intact().begin(), sim.intact().end());
    state.fragments.assign(sim.node_fragments().begin(), sim.node_fragments().end());
    state.fragment_count = sim.fragments().count();
  };
  std::size_t born = 0;  // while a copy was made
  for (int states = 0; states < 3; ++states) {
    const std::uint64_t before = publisher.latest().step;
    while (publisher.latest().step == before) step();
    const PublishedState& state = publisher.latest();
    ASSERT_EQ(state.step, sim.info().step);
    ASSERT_EQ(state.step - state.first_step, kSlices - 1);
    for (std::size_t slice = 0; slice < kSlices; ++slice) {
      const PublishedState& then = past[state.first_step + slice - 1];
      for (std::size_t i = nodes * slice / kSlices; i < nodes * (slice + 1) / kSlices; ++i) {
        ASSERT_EQ(state.positions[i], then.positions[i]) << "node " << i << " in slice " << slice;
        ASSERT_EQ(state.fragments[i], then.fragments[i]) << "node " << i << " in slice " << slice;
      }
      for (std::size_t s = springs * slice / kSlices; s < springs * (slice + 1) / kSlices; ++s) {
        ASSERT_EQ(state.intact[s], then.intact[s]) << "spring " << s << " in slice " << slice;
      }
    }
    ASSERT_EQ(state.fragment_count, sim.fragments().count());
    for (std::size_t f = past[state.first_step - 1].fragment_count; f < state.fragment_count; ++f, ++born) {
      ASSERT_EQ(state.records[f].node_count, sim.fragments().record(static_cast<std::uint32_t>(f)).node_count) << f;
    }
  }
  const PublishedState& state = publisher.latest();
  EXPECT_GT(born, 0u);
  EXPECT_LT(*std::max_element(state.fragments.begin(), state.fragments.end()), state.fragment_count);
  EXPECT_NE(past.back().positions.y, past[past.size() - 2].positions.y);  // steps can be told apart
}

TEST(Publisher, PublishNowIsTheWholeStateOfALargeBodyToo) {
  Simulation sim(torn_box());
  StatePublisher publisher(sim);
  for (int i = 0; i < 20; ++i) sim.step({});
  publisher.publish_now(sim);
  EXPECT_TRUE(is_state_of(sim, publisher.latest()));
}

// Wherever in a copy it happens: what is published next is of the new run alone.
TEST(Publisher, AResetOrARestoreBeginsACopyAgain) {
  Simulation sim(torn_box());
  sim.step({});
  const Vector<std::uint8_t> saved = sim.snapshot();
  StatePublisher publisher(sim);
  for (const bool restore : {false, true}) {
    for (int i = 0; i < 70 || publisher.latest().step + 1 != sim.info().step; ++i) {
      sim.step({});  // to where the next copy begins
      publisher.publish(sim);
    }
    for (int i = 0; i < 8; ++i) sim.step({}), publisher.publish(sim);
    const std::uint64_t before = publisher.latest().step;
    if (restore) sim.restore(saved);
    if (!restore) sim.reset();
    while (publisher.latest().step == before) sim.step({}), publisher.publish(sim);
    EXPECT_LT(publisher.latest().step, 30u);
    EXPECT_EQ(publisher.latest().step - publisher.latest().first_step, kSlices - 1);
  }
}

TEST(Publisher, PassesOnEachEventOnce) {
  PressRig rig("tofu_cube", Preset::standard, 0.02);
  StatePublisher publisher(rig.sim);
  Vector<Event> expected, seen, out(7);
  const auto read = [&] {
    for (std::size_t count = 1; count > 0;) {
      count = publisher.read_events(out);
      seen.insert(seen.end(), out.begin(), out.begin() + static_cast<std::ptrdiff_t>(count));
    }
  };
  while (rig.speed * rig.sim.info().time < 0.02) {
    rig.press();
    publisher.publish(rig.sim);
    expected.insert(expected.end(), rig.sim.events().begin(), rig.sim.events().end());
    if (rig.sim.info().step % 16 == 0) read();
  }
  while (rig.sim.events().empty()) rig.press();
  rig.sim.step({});  // no pose: does not take place, so nothing happens in it
  publisher.publish(rig.sim);
  read();
  ASSERT_EQ(seen.size(), expected.size());
  EXPECT_GT(seen.size(), 100u);
  for (std::size_t i = 0; i < seen.size(); ++i) {
    ASSERT_EQ(seen[i].kind, expected[i].kind) << i;
    ASSERT_EQ(seen[i].step, expected[i].step) << i;
    ASSERT_EQ(seen[i].place, expected[i].place) << i;
  }
  EXPECT_EQ(publisher.events_dropped(), 0u);
}

TEST(Publisher, CountsTheEventsThatNobodyReads) {
  PressRig rig("tofu_cube", Preset::standard, 0.02);
  while (rig.sim.events().empty()) rig.press();
  StatePublisher publisher(rig.sim);
  const std::size_t each = rig.sim.events().size(), times = StatePublisher::kEvents / each + 10;
  for (std::size_t i = 0; i < times; ++i) publisher.publish(rig.sim);
  EXPECT_EQ(publisher.events_dropped(), times * each - StatePublisher::kEvents);
}

TEST(Publisher, AllocatesNothing) {
  if (!AllocationCounter::available()) GTEST_SKIP() << "a sanitizer owns malloc";
  PressRig rig("tofu_cube", Preset::standard, 0.02);
  StatePublisher publisher(rig.sim);
  Vector<Event> out(100);
  std::size_t allocations = 1;
  {
    const AllocationCounter counter;
    while (rig.speed * rig.sim.info().time < 0.02) {
      rig.press();
      publisher.publish(rig.sim);
      if (rig.sim.info().step % 50 == 0) publisher.publish_now(rig.sim);
      publisher.latest();
      publisher.read_events(out);
    }
    allocations = counter.count();
  }
  EXPECT_EQ(allocations, 0u);
  EXPECT_GT(publisher.latest().counters.cuts, 100u);
}

}  // namespace
}  // namespace crumble
