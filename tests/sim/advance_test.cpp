// Several steps in one call.
#include <gtest/gtest.h>

#include "sim/press_rig.hpp"
#include "support/allocation_counter.hpp"

namespace crumble {
namespace {

// As a host would do it by hand.
TEST(Advance, IsTheSameAsStepsAlongTheWay) {
  PressRig one, many;
  one.press_to(0.003), many.press_to(0.003);
  Pose from = one.pose_at(one.sim.info().step - 1), to = from;
  to.position += Vec3(1e-4, -4e-4, 0);
  to.orientation = Quat(0.9999, 0.0141, 0, 0).normalized();
  Wrench mean;
  const AdvanceReport report = one.sim.advance({&to, 1}, 20, 0, {&mean, 1});
  Vec3 force = Vec3::Zero(), torque = Vec3::Zero();
  for (int k = 1; k <= 20; ++k) {
    const Pose here = k == 20 ? to : interpolate(from, renormalized(to), k / 20.0);
    many.sim.step({&here, 1});
    force += many.sim.wrench(0).force, torque += many.sim.wrench(0).torque;
  }
  EXPECT_EQ(one.sim.state_hash(), many.sim.state_hash());
  EXPECT_EQ(report.steps, 20u);
  EXPECT_EQ(report.dropped, 0u);
  EXPECT_GT(report.seconds, 0);
  EXPECT_LT(norm(mean.force - force / 20), 1e-12);
  EXPECT_LT(norm(mean.torque - torque / 20), 1e-12);
  EXPECT_GT(mean.force.y(), 0.1);
}

TEST(Advance, AnUnplacedToolIsPutAtThePoseAtOnce) {
  PressRig rig;
  const Pose pose = rig.pose_at(0);
  rig.sim.advance({&pose, 1}, 3, 0);
  EXPECT_TRUE(rig.sim.engaged(0)) << "it has not come through the body from the origin";
  EXPECT_EQ(rig.sim.counters().tool_jumps, 0u);
}

// A budget that no step can keep: one is done, and what was dropped is said. The next call goes on from there.
TEST(Advance, TooSmallABudgetDropsWholeSteps) {
  PressRig rig;
  rig.press_to(0.003);
  const double time = rig.sim.info().time;
  Pose to = rig.pose_at(rig.sim.info().step - 1);
  const double from = to.position.y();
  to.position.y() -= 4e-4;
  const AdvanceReport report = rig.sim.advance({&to, 1}, 20, 1e-9);
  EXPECT_EQ(report.steps, 1u);
  EXPECT_EQ(report.dropped, 19u);
  EXPECT_EQ(rig.sim.counters().dropped_steps, 19u);
  EXPECT_NEAR(rig.sim.info().time, time + 1e-3, 1e-12);
  Wrench wrench;
  const AdvanceReport rest = rig.sim.advance({&to, 1}, 20, 0, {&wrench, 1});
  EXPECT_EQ(rest.steps, 20u);
  PressRig slow;
  slow.press_to(0.003);
  Pose first = to;
  first.position.y() = from - 2e-5;
  slow.sim.step({&first, 1});
  slow.sim.advance({&to, 1}, 20, 0);
  EXPECT_NEAR(slow.sim.wrench(0).force.y(), rig.sim.wrench(0).force.y(), 1e-9);
}

TEST(Advance, ABadPoseStandsStillAndGivesNoForce) {
  PressRig rig;
  rig.press_to(0.003);
  const auto before = rig.sim.info().step;
  Pose bad = rig.pose_at(rig.sim.info().step);
  bad.position.x() = std::numeric_limits<double>::quiet_NaN();
  Wrench wrench{{1, 1, 1}, {1, 1, 1}};
  const AdvanceReport report = rig.sim.advance({&bad, 1}, 20, 0, {&wrench, 1});
  EXPECT_EQ(rig.sim.info().status, Code::bad_pose);
  EXPECT_EQ(rig.sim.info().step, before);
  EXPECT_EQ(report.steps, 0u);
  EXPECT_EQ(report.dropped, 0u);
  EXPECT_EQ(wrench.force, Vec3(Vec3::Zero()));
  EXPECT_EQ(rig.sim.counters().bad_poses, 1u) << "refused once, not twenty times";
}

TEST(Advance, TakesNoMemory) {
  if (!AllocationCounter::available()) GTEST_SKIP() << "nothing is counted here";
  PressRig rig;
  Pose pose = rig.pose_at(0);
  rig.sim.advance({&pose, 1}, 2, 0);
  const AllocationCounter counter;
  for (int frame = 0; frame < 20; ++frame) {
    pose.position.y() -= 4e-4;
    Wrench wrench;
    rig.sim.advance({&pose, 1}, 20, 0.01, {&wrench, 1});
  }
  EXPECT_EQ(counter.count(), 0u);
}

}  // namespace
}  // namespace crumble
