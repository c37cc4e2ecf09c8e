// The log of events against what the state says.
#include <gtest/gtest.h>

#include <map>

#include "crumble/base/memory.hpp"
#include "sim/crumbling_rig.hpp"
#include "support/allocation_counter.hpp"

namespace crumble {
namespace {

Vector<Event> of_kind(const Simulation& sim, EventKind kind) {
  Vector<Event> found;
  for (const Event& event : sim.events()) {
    if (event.kind == kind) found.push_back(event);
  }
  return found;
}

TEST(Events, EveryCutIsToldWithPlaceTimeAndEnergy) {
  CrumblingRig rig;
  const SpringNetwork& network = rig.sim.network();
  std::size_t told = 0;
  for (int step = 0; step < 1000; ++step) {
    rig.press();
    const auto cuts = of_kind(rig.sim, EventKind::cut);
    ASSERT_EQ(cuts.size(), rig.sim.new_cuts().size());
    for (std::size_t k = 0; k < cuts.size(); ++k) {
      EXPECT_EQ(cuts[k].spring, rig.sim.new_cuts()[k]);
      EXPECT_EQ(cuts[k].step, rig.sim.info().step - 1);
      EXPECT_EQ(cuts[k].time, rig.sim.info().time);
      const auto [a, b] = network.springs[cuts[k].spring];
      const Vec3 p = rig.sim.positions()[a], q = rig.sim.positions()[b];
      EXPECT_LT(norm(cuts[k].place - 0.5 * (p + q)), 1e-15);
      // a spring is cut at its limit, a little beyond it when it went there in one step
      const double rest = network.rest_lengths[cuts[k].spring], k_of = network.stiffnesses[cuts[k].spring];
      const double at_limit = 0.5 * k_of * rest * rest * 0.1 * 0.1;
      EXPECT_GT(cuts[k].energy, 0.8 * at_limit);
      EXPECT_NEAR(cuts[k].energy, 0.5 * k_of * (norm(q - p) - rest) * (norm(q - p) - rest), 1e-18);
    }
    told += cuts.size();
  }
  EXPECT_GT(told, 100u);
  EXPECT_EQ(told, rig.sim.counters().cuts);
  EXPECT_EQ(rig.sim.counters().dropped_events, 0u);
}

TEST(Events, SplitsBuildTheFamilyTree) {
  CrumblingRig rig;
  std::size_t splits = 0;
  for (int step = 0; step < 1500; ++step) {
    rig.press();
    for (const Event& event : of_kind(rig.sim, EventKind::split)) {
      ++splits;
      EXPECT_EQ(event.fragment, splits) << "ids are given in order";
      EXPECT_LT(event.parent, event.fragment);
      EXPECT_EQ(rig.sim.fragments().record(event.fragment).parent, event.parent);
      EXPECT_EQ(rig.sim.fragments().record(event.fragment).born, event.step);
      EXPECT_EQ(rig.sim.node_fragments()[event.node], event.fragment);
      EXPECT_EQ(event.place, rig.sim.positions()[event.node]);
    }
  }
  EXPECT_GT(splits, 3u);
  EXPECT_EQ(rig.sim.fragments().count(), splits + 1);
}

// Beginnings and ends, played back, give the contacts of every step.
TEST(Events, ContactsBeginAndEnd) {
  CrumblingRig rig;
  std::map<std::uint32_t, std::uint32_t> holders;
  std::size_t begins = 0, ends = 0;
  double hardest = 0;
  const auto check = [&] {
    for (const Event& event : rig.sim.events()) {
      if (event.kind == EventKind::contact_end) {
        ++ends;
        // where the holder changed, the beginning was told first
        if (holders.at(event.node) == event.holder) holders.erase(event.node);
      }
      if (event.kind == EventKind::contact_begin) {
        ++begins;
        holders[event.node] = event.holder;
        hardest = std::max(hardest, event.energy);
        EXPECT_EQ(event.fragment, rig.sim.node_fragments()[event.node]);
      }
    }
    std::map<std::uint32_t, std::uint32_t> held;
    for (const NodeConstraint& c : rig.sim.contacts()) held[c.node] = c.holder;
    ASSERT_EQ(holders, held) << "step " << rig.sim.info().step;
  };
  for (int step = 0; step < 800; ++step) rig.press(), check();
  for (int step = 0; step < 300; ++step) rig.lift(), check();
  EXPECT_GT(begins, 20u);
  EXPECT_GT(ends, 20u);
  // the stick comes at 20 mm/s upon the heaviest node at rest, or a little more
  double heaviest = 0;
  for (const double m : rig.sim.network().masses) heaviest = std::max(heaviest, m);
  EXPECT_GT(hardest, 0);
  EXPECT_LT(hardest, 4 * 0.5 * heaviest * 0.02 * 0.02);
}

TEST(Events, TheFirstTouchTellsTheSpeedOfImpact) {
  CrumblingRig rig;
  while (of_kind(rig.sim, EventKind::contact_begin).empty() || rig.sim.info().contacts == 0) rig.press();
  for (const Event& event : of_kind(rig.sim, EventKind::contact_begin)) {
    if (event.holder == Event::kNone) continue;
    const double mass = rig.sim.network().masses[event.node];
    // the body has sunk under its weight at less than a tenth of the stick's speed
    EXPECT_NEAR(event.energy, 0.5 * mass * 0.02 * 0.02, 0.25 * 0.5 * mass * 0.02 * 0.02);
  }
}

TEST(Events, AfterARestoreOnlyNewThingsAreTold) {
  CrumblingRig rig;
  for (int step = 0; step < 700; ++step) rig.press();
  const auto bytes = rig.sim.snapshot();
  CrumblingRig other;
  for (int step = 0; step < 300; ++step) other.press();
  other.sim.restore(bytes);
  EXPECT_TRUE(other.sim.events().empty());
  other.pose = rig.pose;
  for (int step = 0; step < 200; ++step) {
    rig.press(), other.press();
    ASSERT_EQ(rig.sim.events().size(), other.sim.events().size());
    for (std::size_t k = 0; k < rig.sim.events().size(); ++k) {
      const Event &a = rig.sim.events()[k], &b = other.sim.events()[k];
      EXPECT_TRUE(a.kind == b.kind && a.spring == b.spring && a.node == b.node && a.holder == b.holder &&
                  a.fragment == b.fragment && a.parent == b.parent && a.step == b.step && a.place == b.place &&
                  a.energy == b.energy);
    }
  }
}

TEST(Events, StepsWithSplitsAllocateNothing) {
  if (!AllocationCounter::available()) GTEST_SKIP() << "allocations are not counted here";
  CrumblingRig rig;
  rig.press();
  std::size_t allocations = 0;
  {
    const AllocationCounter counter;
    for (int step = 0; step < 1200; ++step) rig.press();
    allocations = counter.count();
  }
  EXPECT_GT(rig.sim.fragments().count(), 3u);
  EXPECT_EQ(allocations, 0u);
}

}  // namespace
}  // namespace crumble
