// The whole press in floats and in doubles, and by every kernel.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "crumble/base/memory.hpp"
#include "sim/press_rig.hpp"

namespace crumble {
namespace {

PressRig make_rig(Precision precision, const std::string& kernel, double speed, const char* scene = "tofu_cube") {
  PressRig rig(scene, Preset::standard, speed);
  rig.scene.def.step.precision = precision;
  rig.scene.def.step.kernel = kernel;
  rig.sim = Simulation(rig.scene.def);
  return rig;
}

TEST(Precision, EveryKernelPressesToTheSameBits) {
  for (const Precision precision : {Precision::float64, Precision::float32}) {
    PressRig scalar = make_rig(precision, "scalar", 0.035);
    Vector<PressRig> others;
    for (const std::string& kernel : kernel_names()) others.push_back(make_rig(precision, kernel, 0.035));
    for (int step = 0; step < 500; ++step) {
      scalar.press();
      for (PressRig& other : others) {
        other.press();
        ASSERT_EQ(other.sim.state_hash(), scalar.sim.state_hash()) << other.sim.kernel() << ", step " << step;
      }
    }
    EXPECT_GT(scalar.sim.counters().cuts, 50u);
  }
}

struct Curves {
  Vector<Vec3> in_doubles, in_floats;  // force on the tool by step, N
  double peak = 0;
};

Curves press_until_the_first_cut(const char* scene, double speed) {
  PressRig doubles = make_rig(Precision::float64, "", speed, scene),
           floats = make_rig(Precision::float32, "", speed, scene);
  Curves curves;
  while (doubles.sim.counters().cuts + floats.sim.counters().cuts == 0) {
    doubles.press(), floats.press();
    curves.in_doubles.push_back(doubles.sim.wrench(0).force);
    curves.in_floats.push_back(floats.sim.wrench(0).force);
    curves.peak = std::max(curves.peak, norm(curves.in_doubles.back()));
  }
  return curves;
}

// docs/numerics.md: the force curve to 0.5 % of its peak until the first cut. Where a node passes from one face of the
// tool to the next the force jumps, by 2 % at most, and rounding may put that a step earlier or later.
TEST(Precision, FloatsFeelLikeDoublesUntilTheFirstCut) {
  for (const char* scene : {"tofu_cube", "tofu_cube_upright", "tofu_globe"}) {
    for (const double speed : {0.001, 0.01}) {
      const Curves c = press_until_the_first_cut(scene, speed);
      EXPECT_GT(c.peak, 0.3);
      std::size_t late = 0;
      for (std::size_t i = 1; i + 1 < c.in_floats.size(); ++i) {
        const auto apart = [&](std::size_t k) { return norm(c.in_floats[i] - c.in_doubles[k]); };
        ASSERT_LE(std::min({apart(i - 1), apart(i), apart(i + 1)}), 0.005 * c.peak)
            << scene << " at " << speed << " m/s, step " << i;
        late += apart(i) > 0.005 * c.peak;
      }
      EXPECT_LE(late, c.in_floats.size() / 1000) << scene << " at " << speed << " m/s";
    }
  }
}

// Cuts follow from comparisons that rounding decides, so the pieces differ; the ways of breaking do not.
TEST(Precision, FloatsBreakTheBodyAlike) {
  PressRig exact = make_rig(Precision::float64, "", 0.005), rig = make_rig(Precision::float32, "", 0.005);
  exact.press_to(0.02), rig.press_to(0.02);
  const auto cuts = static_cast<double>(exact.sim.counters().cuts);
  EXPECT_GT(cuts, 50);
  EXPECT_NEAR(static_cast<double>(rig.sim.counters().cuts), cuts, 0.2 * cuts);
}

// numerics.md, the energy audit in floats.
TEST(Precision, TheSolveStageInFloatsGainsNoMoreThanRounding) {
  PressRig rig = make_rig(Precision::float32, "", 0.01);
  rig.scene.def.step.energy_audit = true;
  rig.sim = Simulation(rig.scene.def);
  rig.press_to(0.02);
  const EnergyLedger& l = rig.sim.ledger();
  EXPECT_LE(l.gain_max_relative, 1e-9);
  EXPECT_GT(l.cut, 0);
  EXPECT_NEAR(l.stored, l.tool_work + l.external_work - l.dissipated - l.cut, 1e-12 * l.tool_work);
}

TEST(Precision, ASnapshotInFloatsContinuesWithTheSameHashes) {
  PressRig rig = make_rig(Precision::float32, "", 0.01);
  rig.press_to(0.014);
  while (rig.sim.info().new_cuts == 0) rig.press();  // in the middle of a fade
  const auto bytes = rig.sim.snapshot();
  PressRig other = make_rig(Precision::float32, "scalar", 0.01);
  other.press_to(0.003);
  other.sim.restore(bytes);
  EXPECT_EQ(other.sim.snapshot(), bytes);
  for (int step = 0; step < 400; ++step) {
    rig.press(), other.press();
    ASSERT_EQ(other.sim.state_hash(), rig.sim.state_hash()) << "step " << step;
  }
  PressRig exact = make_rig(Precision::float64, "", 0.01);
  EXPECT_THROW(exact.sim.restore(bytes), Error);  // of another precision
}

}  // namespace
}  // namespace crumble
