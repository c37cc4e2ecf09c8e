// Pieces that sleep, wake and are taken away.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>

#include "crumble/base/memory.hpp"
#include "crumble/fracture/fragments.hpp"
#include "crumble/sim/recording.hpp"
#include "sim/crumbling_rig.hpp"
#include "support/allocation_counter.hpp"

namespace crumble {
namespace {

// Broken, and the stick gone up out of it.
struct Rubble : CrumblingRig {
  explicit Rubble(bool balls = true) : CrumblingRig(balls) {
    for (int step = 0; step < 1300; ++step) press();
    for (int step = 0; step < 1600; ++step) lift();
  }
  std::uint32_t smallest() const {
    std::uint32_t least = 0;
    for (std::uint32_t f = 0; f < sim.fragments().count(); ++f) {
      if (sim.fragments().record(f).node_count < sim.fragments().record(least).node_count) least = f;
    }
    return least;
  }
  Vector<std::uint32_t> nodes_of(std::uint32_t fragment) const {
    Vector<std::uint32_t> nodes;
    for (std::uint32_t n = 0; n < sim.mesh().node_count(); ++n) {
      if (sim.node_fragments()[n] == fragment) nodes.push_back(n);
    }
    return nodes;
  }
  Vector<Vec3> places(const Vector<std::uint32_t>& nodes) const {
    Vector<Vec3> places;
    for (const std::uint32_t n : nodes) places.push_back(sim.positions()[n]);
    return places;
  }
};

TEST(Debris, LabelsAreThoseOfAFloodFillAllTheWay) {
  CrumblingRig rig;
  FragmentLabeler labeler(rig.sim.mesh().node_count(), rig.sim.mesh().springs);
  for (int step = 0; step < 1500; ++step) {
    rig.press();
    if (rig.sim.info().new_cuts == 0) continue;
    ASSERT_EQ(labeler.label(rig.sim.intact()), rig.sim.fragments().count());
    for (const auto& [a, b] : rig.sim.mesh().springs) {
      ASSERT_EQ(labeler.labels()[a] == labeler.labels()[b], rig.sim.node_fragments()[a] == rig.sim.node_fragments()[b]);
    }
  }
  EXPECT_GT(rig.sim.fragments().count(), 5u);
}

TEST(Debris, FindsWhatIsSmallSlowAndNotHeld) {
  Rubble rubble;
  const auto found = rubble.sim.find_debris({5, 1e3});
  for (std::uint32_t f = 0; f < rubble.sim.fragments().count(); ++f) {
    const bool is_in = std::find(found.begin(), found.end(), f) != found.end();
    EXPECT_EQ(is_in, rubble.sim.fragments().record(f).node_count <= 5) << f;
  }
  EXPECT_GT(found.size(), 2u);
  EXPECT_TRUE(rubble.sim.find_debris({5, 0}).empty());
  EXPECT_TRUE(rubble.sim.find_debris({5, -1e3}).empty());
  // a speed limit takes exactly those whose fastest node is slower
  const double limit = 2e-4;
  const auto slow = rubble.sim.find_debris({5, limit});
  for (std::uint32_t f = 0; f < rubble.sim.fragments().count(); ++f) {
    double fastest = 0;
    for (const std::uint32_t n : rubble.nodes_of(f)) fastest = std::max(fastest, norm(rubble.sim.velocities()[n]));
    const bool is_in = std::find(slow.begin(), slow.end(), f) != slow.end();
    EXPECT_EQ(is_in, rubble.sim.fragments().record(f).node_count <= 5 && fastest < limit) << f;
  }
  CrumblingRig held;
  for (int step = 0; step < 600; ++step) held.press();
  ASSERT_GT(held.sim.info().contacts, 0u);
  const std::uint32_t f = held.sim.node_fragments()[held.sim.contacts()[0].node];
  const auto all = held.sim.find_debris({100000, 1e3});
  EXPECT_EQ(std::count(all.begin(), all.end(), f), 0);
}

TEST(Debris, ASleepingFragmentStandsStillWhileTheOthersGoOn) {
  Rubble asleep(false), awake(false);  // a sleeper that others could run into would change their way
  const std::uint32_t f = asleep.smallest();
  asleep.sim.set_fragment_state(f, FragmentState::asleep);
  EXPECT_EQ(asleep.sim.counters().asleep, 1u);
  const auto nodes = asleep.nodes_of(f);
  const auto before = asleep.places(nodes);
  for (int step = 0; step < 300; ++step) asleep.lift(), awake.lift();
  EXPECT_EQ(asleep.places(nodes), before);
  EXPECT_NE(awake.places(nodes), before) << "it would have moved";
  for (const std::uint32_t n : nodes) EXPECT_EQ(asleep.sim.velocities()[n], Vec3::Zero());
  for (std::uint32_t n = 0; n < asleep.sim.mesh().node_count(); ++n) {
    if (asleep.sim.node_fragments()[n] == f) continue;
    EXPECT_EQ(asleep.sim.positions()[n], awake.sim.positions()[n]);
  }
  asleep.sim.set_fragment_state(f, FragmentState::active);
  EXPECT_EQ(asleep.sim.counters().asleep, 0u);
  for (int step = 0; step < 300; ++step) asleep.lift();
  EXPECT_NE(asleep.places(nodes), before);
}

TEST(Debris, AToolWakesWhatItTouches) {
  Rubble rubble;
  for (const std::uint32_t f : Vector<std::uint32_t>(rubble.sim.find_debris({100000, 1e3}).begin(),
                                                     rubble.sim.find_debris({100000, 1e3}).end())) {
    rubble.sim.set_fragment_state(f, FragmentState::asleep);
  }
  const std::uint64_t asleep = rubble.sim.counters().asleep;
  ASSERT_EQ(asleep, rubble.sim.fragments().count());
  int steps = 0;
  while (rubble.sim.counters().woken == 0 && steps++ < 3000) rubble.press();
  EXPECT_EQ(rubble.sim.counters().woken + rubble.sim.counters().asleep, asleep);
  EXPECT_GT(rubble.sim.info().contacts, 0u);
  const std::uint32_t f = rubble.sim.node_fragments()[rubble.sim.contacts()[0].node];
  EXPECT_EQ(rubble.sim.fragment_state(f), FragmentState::active);
  EXPECT_GT(norm(rubble.sim.wrench(0).force), 0);
}

TEST(Debris, WhatIsRemovedIsNotThereAnyMore) {
  Rubble rubble;
  const auto debris = rubble.sim.find_debris({10, 1e3});
  const Vector<std::uint32_t> gone(debris.begin(), debris.end());
  ASSERT_GT(gone.size(), 2u);
  std::size_t node_count = 0;
  Vector<std::uint32_t> nodes;
  for (const std::uint32_t f : gone) {
    for (const std::uint32_t n : rubble.nodes_of(f)) nodes.push_back(n);
    node_count += rubble.sim.fragments().record(f).node_count;
    rubble.sim.set_fragment_state(f, FragmentState::removed);
  }
  EXPECT_EQ(rubble.sim.counters().removed, gone.size());
  EXPECT_EQ(rubble.sim.counters().removed_nodes, node_count);
  for (const std::uint32_t n : nodes) EXPECT_EQ(rubble.sim.node_fragments()[n], kNoFragment);
  const auto before = rubble.places(nodes);
  for (int step = 0; step < 1500; ++step) {
    rubble.press();
    for (const NodeConstraint& c : rubble.sim.contacts()) {
      ASSERT_EQ(std::count(nodes.begin(), nodes.end(), c.node), 0) << "held though removed";
    }
  }
  EXPECT_EQ(rubble.places(nodes), before);
  EXPECT_EQ(rubble.sim.fragment_state(gone[0]), FragmentState::removed);
}

TEST(Debris, RefusesWhatCannotBe) {
  Rubble rubble;
  const auto code_of = [&](std::uint32_t fragment, FragmentState state) {
    try {
      rubble.sim.set_fragment_state(fragment, state);
    } catch (const Error& error) {
      return error.code();
    }
    return Code{};
  };
  const auto count = static_cast<std::uint32_t>(rubble.sim.fragments().count());
  EXPECT_EQ(code_of(count, FragmentState::asleep), Code::out_of_range);
  EXPECT_EQ(code_of(count - 1, FragmentState::removed), Code{});
  EXPECT_EQ(code_of(count - 1, FragmentState::removed), Code::state);
  EXPECT_EQ(code_of(count - 1, FragmentState::active), Code::state);
  EXPECT_EQ(code_of(0, FragmentState::active), Code{});
}

TEST(Debris, SnapshotsRecordingsAndResetsKnowOfIt) {
  Rubble rubble;
  Recording recording(rubble.sim);
  const auto change = [&](std::uint32_t f, FragmentState state) {
    rubble.sim.set_fragment_state(f, state);
    recording.add_fragment_state(f, state);
  };
  const auto press = [&] {
    rubble.press();
    recording.add({&rubble.pose, 1}, rubble.sim.state_hash());
  };
  const Vector<std::uint32_t> debris(rubble.sim.find_debris({10, 1e3}).begin(),
                                     rubble.sim.find_debris({10, 1e3}).end());
  ASSERT_GT(debris.size(), 2u);
  change(debris[0], FragmentState::asleep);
  change(debris[1], FragmentState::removed);
  for (int step = 0; step < 100; ++step) press();
  change(debris[2], FragmentState::asleep);
  for (int step = 0; step < 100; ++step) press();

  Rubble other;
  other.sim.restore(rubble.sim.snapshot());
  EXPECT_EQ(other.sim.state_hash(), rubble.sim.state_hash());
  EXPECT_EQ(other.sim.counters().asleep, rubble.sim.counters().asleep);
  EXPECT_EQ(other.sim.counters().removed_nodes, rubble.sim.counters().removed_nodes);
  other.pose = rubble.pose;
  for (int step = 0; step < 1200; ++step) {  // down to the pieces, which wakes some
    press(), other.press();
    ASSERT_EQ(other.sim.state_hash(), rubble.sim.state_hash()) << step;
  }

  const auto path = std::filesystem::temp_directory_path() / "crumble_debris.crec";
  recording.save(path);
  const Recording loaded = Recording::load(path);
  std::filesystem::remove(path);
  Simulation again = loaded.start();
  EXPECT_EQ(replay(loaded, again), std::nullopt);
  EXPECT_EQ(again.counters().removed, 1u);

  rubble.sim.reset();
  EXPECT_EQ(rubble.sim.state_hash(), Simulation(rubble.scene.def).state_hash());
  EXPECT_EQ(rubble.sim.counters().asleep + rubble.sim.counters().removed, 0u);
}

TEST(Debris, TakesEnergyOutAndNeverPutsAnyIn) {
  Scene scene = CrumblingRig::weak_cube();
  scene.def.step.energy_audit = true;
  Simulation sim(scene.def);
  Pose pose = scene.motions[0].start;
  pose.position.y() += 5e-4;
  for (int step = 0; step < 2200; ++step) {
    pose.position.y() += step < 1250 || step > 1700 ? -2e-5 : 2e-5;
    sim.step({&pose, 1});
    if (step % 50 != 0) continue;
    for (const std::uint32_t f : sim.find_debris({20, 1e3})) {
      sim.set_fragment_state(f, step % 100 == 0 ? FragmentState::asleep : FragmentState::active);
    }
  }
  EXPECT_GT(sim.fragments().count(), 3u);
  const EnergyLedger& l = sim.ledger();
  EXPECT_LE(l.gain_max_relative, 1e-12);
  EXPECT_NEAR(l.stored, l.tool_work + l.external_work - l.dissipated - l.cut, 1e-12 * l.tool_work);
}

TEST(Debris, AllocatesNothing) {
  if (!AllocationCounter::available()) GTEST_SKIP() << "allocations are not counted here";
  Rubble rubble;
  const AllocationCounter counter;
  for (const std::uint32_t f : rubble.sim.find_debris({10, 1e3})) {
    rubble.sim.set_fragment_state(f, f % 2 ? FragmentState::asleep : FragmentState::removed);
  }
  for (int step = 0; step < 1500; ++step) rubble.press();
  EXPECT_EQ(counter.count(), 0u);
}

// The last springs of a crumb pull while they fade: it goes with what it came off until they have.
TEST(Debris, FadingSpringsThrowNoCrumbs) {
  CrumblingRig rig(false);
  double fastest = 0;
  for (int step = 0; step < 1300; ++step) {
    rig.press();
    const FragmentTracker& fragments = rig.sim.fragments();
    for (std::uint32_t node = 0; node < rig.sim.mesh().node_count(); ++node) {
      const FragmentRecord& record = fragments.record(fragments.labels()[node]);
      const bool came_off = record.parent != kNoFragment && rig.sim.info().step < record.born + 10;
      if (came_off) fastest = std::max(fastest, norm(rig.sim.velocities()[node]));
    }
  }
  EXPECT_GT(rig.sim.fragments().count(), 3u);
  EXPECT_LT(fastest, 0.1);  // m/s; 0.05, and 0.14 when nothing holds them back
}

}  // namespace
}  // namespace crumble
