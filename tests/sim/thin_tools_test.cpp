// Thin tools against the paper's cube, whose nodes are 4.4 mm apart: whole presses.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>

#include "crumble/base/memory.hpp"
#include "crumble/base/random.hpp"
#include "crumble/geometry/tool_solids.hpp"
#include "crumble/sim/simulation.hpp"
#include "scenes/scene.hpp"
#include "support/allocation_counter.hpp"

namespace crumble {
namespace {

struct Press {
  std::string name;
  Solid shape;
  bool upright;
  double half_height;  // of the tool as it stands
};

Vector<Press> presses() {
  const Solid round = make_round_stick(0.004, 0.05, 16), square = make_bar({0.006, 0.006, 0.05}),
              flat = make_bar({0.003, 0.01, 0.05}), needle = make_round_stick(0.001, 0.03, 16);
  return {{"round lying", round, false, 0.004},   {"round upright", round, true, 0.025},
          {"square lying", square, false, 0.003}, {"square upright", square, true, 0.025},
          {"flat lying", flat, false, 0.005},     {"flat upright", flat, true, 0.025},
          {"needle upright", needle, true, 0.015}};
}

constexpr double kTop = 0.03;  // of the cube, metres

struct ThinRig {
  Press press;
  Simulation sim;
  double x = 0, z = 0;

  explicit ThinRig(const Press& which, bool samples = true) : press(which), sim(definition(which, samples)) {}

  static SimulationDef definition(const Press& press, bool samples) {
    SimulationDef def = load_scene("tofu_cube", Preset::standard).def;
    def.tools[0].shape = press.shape;
    def.step.surface_samples = samples;
    return def;
  }
  // `depth` metres below the top of the cube; upright: -Z looks down
  const StepInfo& to(double depth) {
    const Pose pose{{x, kTop + press.half_height - depth, z},
                    press.upright ? axis_angle(Vec3::UnitX(), -M_PI / 2) : Quat::Identity()};
    return sim.step({&pose, 1});
  }
  /// Somewhere on the top of the unbroken cube, 1 mm deep at 50 mm/s: the greatest force up on the tool.
  double peak_somewhere(Random& random, double depth = 1e-3) {
    sim.reset();
    x = random.uniform(-0.015, 0.015), z = random.uniform(-0.015, 0.015);
    double peak = 0;
    for (int step = 0; 5e-5 * step <= depth; ++step) {
      to(5e-5 * step);
      peak = std::max(peak, sim.wrench(0).force.y());
    }
    return peak;
  }
};

TEST(ThinTools, EveryPressAtAThousandPlacesMeetsResistance) {
  for (const Press& press : presses()) {
    ThinRig rig(press);
    Random random(71);
    for (int trial = 0; trial < 1000; ++trial) {
      ASSERT_GT(rig.peak_somewhere(random), 0.01) << press.name << " at " << rig.x << ", " << rig.z;
    }
  }
}

TEST(ThinTools, NodesAloneMissMostOfTheNeedles) {
  ThinRig rig(presses().back(), false);
  Random random(71);
  int met = 0;
  for (int trial = 0; trial < 200; ++trial) met += rig.peak_somewhere(random) > 0;
  EXPECT_LT(met, 60);
}

// Thicker than the nodes are apart, but not where they meet the body.
TEST(SharpTools, MeetResistanceBetweenNodes) {
  const Vector<std::pair<Solid, bool>> shapes{{make_cone(0.005, 0.02), true},
                                              {make_blade({0.01, 0.02, 0.05}, 0.02), false}};
  for (const auto& [shape, upright] : shapes) {
    int met[2] = {0, 0};
    for (const bool samples : {false, true}) {
      ThinRig rig({"sharp", shape, upright, 0.01}, samples);
      Random random(72);
      for (int trial = 0; trial < 200; ++trial) met[samples] += rig.peak_somewhere(random, 0.0025) > 0.005;
    }
    EXPECT_EQ(met[1], 200);
    EXPECT_LT(met[0], 150);
  }
}

TEST(ThinTools, NeedlesForceIsSmoothThroughCuts) {
  ThinRig rig(presses().back());
  rig.x = 0.0013, rig.z = 0.0007;
  Vec3 before = Vec3::Zero();
  double greatest = 0;
  for (int step = 0; step <= 15000; ++step) {  // 1 mm/s, 15 mm
    rig.to(1e-6 * step);
    greatest = std::max(greatest, norm(rig.sim.wrench(0).force - before));
    before = rig.sim.wrench(0).force;
  }
  EXPECT_GT(rig.sim.counters().cuts, 10u);
  EXPECT_LT(greatest, 0.05) << "N per millisecond";
}

// 30 places, 10 mm/s, 15 mm: the table of docs/contact.md. The target of 0.1 N is missed by thin tools.
TEST(ThinTools, ForceIsNearlySmoothAtThirtyPlaces) {
  const Vector<Press> all = presses();
  for (const std::size_t which : {0u, 4u, 5u, 6u}) {
    ThinRig rig(all[which]);
    Random random(5);
    double greatest = 0;
    for (int place = 0; place < 30; ++place) {
      rig.sim.reset();
      rig.x = random.uniform(-0.012, 0.012), rig.z = random.uniform(-0.012, 0.012);
      Vec3 before = Vec3::Zero();
      for (int step = 0; step <= 1500; ++step) {
        rig.to(1e-5 * step);
        greatest = std::max(greatest, norm(rig.sim.wrench(0).force - before));
        before = rig.sim.wrench(0).force;
      }
    }
    std::printf("%s: %.3f N per ms\n", all[which].name.c_str(), greatest);
    EXPECT_LT(greatest, 0.2) << all[which].name;
  }
}

TEST(ThinTools, SamplesChangeNothingForAThickTool) {
  ThinRig with(presses()[1]), without(presses()[1], false);
  for (int step = 0; step < 300; ++step) with.to(2e-5 * step), without.to(2e-5 * step);
  EXPECT_GT(with.sim.wrench(0).force.y(), 0.1);
  EXPECT_EQ(with.sim.state_hash(), without.sim.state_hash());
}

TEST(ThinTools, ContinueFromASnapshotWithTheSameBits) {
  ThinRig live(presses()[5]);
  live.x = 0.002, live.z = 0.001;
  int step = 0;
  while (live.sim.counters().cuts < 5) live.to(2e-5 * step++);
  ThinRig restored(presses()[5]);
  restored.x = live.x, restored.z = live.z;
  restored.sim.restore(live.sim.snapshot());
  for (int k = 0; k < 300; ++k, ++step) {
    live.to(2e-5 * step), restored.to(2e-5 * step);
    ASSERT_EQ(live.sim.state_hash(), restored.sim.state_hash()) << step;
  }
}

TEST(ThinTools, StepWithoutAllocating) {
  if (!AllocationCounter::available()) GTEST_SKIP() << "malloc is not counted in this build";
  ThinRig rig(presses()[5]);
  for (int step = 0; step < 700; ++step) {
    const AllocationCounter allocations;
    rig.to(2e-5 * step);
    ASSERT_EQ(allocations.count(), 0u) << step;
  }
  EXPECT_GT(rig.sim.counters().cuts, 0u);
}

// A stick, thick or thin, that presses, slides and turns about its axis.
TEST(TurningTools, FrictionConeHoldsAtEachContact) {
  for (const std::size_t which : {0u, 5u}) {
    SimulationDef def = ThinRig::definition(presses()[which], true);
    def.tools[0].friction = {0.6, 0.4};
    Simulation sim(def);
    std::size_t stuck = 0, slid = 0;
    for (int step = 0; step < 1500; ++step) {
      const double s = 1e-3 * step;
      const Quat upright = presses()[which].upright ? axis_angle(Vec3::UnitX(), M_PI / 2) : Quat::Identity();
      const Pose pose{{0.002 * std::sin(5 * s), kTop + presses()[which].half_height - 0.004 * s, 0},
                      multiply(axis_angle(presses()[which].upright ? Vec3::UnitY() : Vec3::UnitZ(), 2 * s), upright)};
      sim.step({&pose, 1});
      for (const NodeConstraint& c : sim.contacts()) {
        if (c.holder == kWorldHolder || c.state == ContactState::fresh) continue;
        const double pressing = c.reaction.dot(c.normal), along = (c.reaction - pressing * c.normal).norm();
        ASSERT_GE(pressing, 0);
        ++(c.state == ContactState::stick ? stuck : slid);
        if (c.state == ContactState::stick) {
          ASSERT_LE(along, 0.6 * pressing * (1 + 1e-12));
        } else {
          ASSERT_NEAR(along, 0.4 * pressing, 1e-12 * pressing);
        }
      }
    }
    EXPECT_GT(stuck, 500u) << presses()[which].name;
    EXPECT_GT(slid, 500u) << presses()[which].name;
  }
}

}  // namespace
}  // namespace crumble
