// A hand in the loop: what must be stable is, and what must not be so called is not. `crumble zwidth` shows the whole.
#include "closed_loop/closed_loop.hpp"

#include <gtest/gtest.h>

namespace crumble::closed_loop {
namespace {

using LoopSetup = Setup;  // a Setup of GoogleTest's is in the way

/// The 16 combinations of one grip.
class ClosedLoop : public testing::TestWithParam<Grip> {
 protected:
  template <class Look>
  static void each(const LoopSetup& setup, Look&& look) {
    for (const Case& c : all_cases()) {
      if (std::string(c.grip.name) == GetParam().name) look(c, press(c, setup));
    }
  }
  static void expect_all_pass(const LoopSetup& setup) {
    each(setup, [&](const Case& c, const Outcome& o) {
      EXPECT_EQ(failure(o, setup), "") << to_string(c) << ": " << o.least_energy << " J, " << o.hold_speed << " m/s, "
                                       << o.hold_span << " m";
    });
  }
};

TEST_P(ClosedLoop, DefaultIsStable) {
  each(default_setup(), [](const Case& c, const Outcome& o) {
    EXPECT_EQ(failure(o, default_setup()), "") << to_string(c);
    EXPECT_NEAR(o.observed_least, o.least_energy, 1e-9) << to_string(c);  // the observer tells the truth
    EXPECT_GT(o.depth, 2e-4) << to_string(c);                             // it did press
    EXPECT_GT(o.peak_force, 0.05) << to_string(c);
  });
}

TEST_P(ClosedLoop, DefaultIsStableByAnEncoderToTheSidesWithLittleDamping) {
  LoopSetup setup = default_setup();
  setup.encoder_step = kEncoderStep;
  setup.lateral = true;
  setup.max_damping = 4;
  expect_all_pass(setup);
}

TEST_P(ClosedLoop, DampingAloneIsStableByContinuousPositions) {
  expect_all_pass(damping_only());
}

// Every combination that needs more damping than there is says so; those that say nothing are stable.
TEST_P(ClosedLoop, DampingAloneWarnsWhereItDoesNotSuffice) {
  LoopSetup setup = damping_only();
  setup.max_damping = 4;
  each(setup, [&](const Case& c, const Outcome& o) {
    EXPECT_EQ(o.capped > 0, o.required_damping > 4) << to_string(c);
    EXPECT_TRUE(o.capped > 0 || passes(o, setup)) << to_string(c) << ": " << failure(o, setup);
  });
}

INSTANTIATE_TEST_SUITE_P(Grips, ClosedLoop, testing::Values(kLoose, kFirm, kBare),
                         [](const auto& grip) { return std::string(grip.param.name); });

// Deep in the body, with friction: the tool hangs quietly between hand and body, though all its contacts slide. (It ran
// to and fro by 0.9 mm a tick once, and the hand felt nothing but that.)
TEST(ClosedLoopWith, FrictionTheToolDoesNotRunToAndFro) {
  LoopSetup setup = default_setup();
  setup.lateral = true, setup.depth = 0.022, setup.hold = 1;
  const Outcome o = press({{"rigid", 1, 20000, 200}, 30, 1e-3, false, 0}, setup);
  EXPECT_GT(o.cuts, 50u);
  EXPECT_LT(o.tool_jumps, 300u);
  EXPECT_EQ(o.fault, Fault::none);
}

// The tests above have teeth: without what they test, many of the same loops fail.
TEST(ClosedLoopWithout, StabiliserManyFail) {
  int failed = 0;
  for (const Case& c : all_cases()) failed += !passes(press(c, bare_setup()), bare_setup());
  EXPECT_GE(failed, 15);
}

// The paper's best parameters with its mean, for a loose grip.
TEST(ClosedLoopWithout, StabiliserThePapersMeanFailsForALooseGrip) {
  const Case c{kLoose, 30, 2.9e-3, false, 0};
  EXPECT_NE(failure(press(c, paper_setup()), paper_setup()), "");
  EXPECT_EQ(failure(press(c, default_setup()), default_setup()), "");
}

// A body at 333 Hz: held forces ring, the local model does not.
TEST(ClosedLoopWithout, StabiliserASlowBodyNeedsItsModel) {
  const Case c{kLoose, 30, 1e-3, false, 0};
  LoopSetup model = default_setup();
  model.body = BodyCoupling::local_model, model.body_ticks = 3;
  EXPECT_EQ(failure(press(c, model), model), "");
  LoopSetup held = model;
  held.body = BodyCoupling::paper;
  held.coupling = held.damping = false;
  EXPECT_NE(failure(press(c, held), held), "");
}

TEST(ClosedLoopWithout, DampingTheControllerTakesTheEnergyBack) {
  const Case c{kBare, 30, 1e-3, true, 0};
  LoopSetup with = bare_setup();
  with.controller = true;
  const Outcome bare = press(c, bare_setup()), controlled = press(c, with);
  EXPECT_LT(bare.least_energy, -1e-3);
  EXPECT_GT(controlled.least_energy, 0.5 * bare.least_energy);
}

}  // namespace
}  // namespace crumble::closed_loop
