// The loop through C, ticked by the test: the forces of the C++ loop, and what becomes of devices that fail.
#include "crumble/haptics/loop.hpp"

#include <cstdio>
#include <functional>

#include "capi/loop_rig.hpp"
#include "crumble/device/hand.hpp"

namespace crumble {
namespace {

using Loops = LoopTest;

crumble_device open(const crumble_device_def& def) {
  crumble_device device = nullptr;
  EXPECT_RESULT(CRUMBLE_OK, crumble_device_open(&def, &device)) << crumble_last_error();
  return device;
}

// The simulation of the rig.
Simulation twin_of(const Cube& cube, const crumble_sim_def& as) {
  SimulationDef def;
  def.mesh = cube.mesh;
  def.material.length_limit = as.length_limit;
  def.step.tau = as.tau;
  def.fixed_nodes = nodes_below(def.mesh, 1e-6);
  def.tools.push_back({make_round_stick(0.004, 0.05, 16), {3, 1.5}, {}});
  return Simulation(std::move(def));
}

class SameBits : public LoopTest {
 protected:
  // Two seconds of a hand that presses and stays, tick by tick beside the C++ loop.
  void expect_like(LoopDef twin_def, bool start) {
    HandOptions options{.start = {{0, 0.002, 0}, Quat::Identity()}, .points = {}};
    for (const crumble_motion_point& p : kPoints) options.points.push_back({p.time, {p.move[0], p.move[1], p.move[2]}});
    SimulatedHand twin_hand(options, 1e-3);
    Simulation twin = twin_of(cube, def);
    twin_def.driver = LoopDriver::host;
    twin_def.hands.resize(1);
    twin_def.hands[0].device = &twin_hand;
    twin_def.hands[0].workspace.pose.position.y() = 0.034;
    change(twin_def.hands[0]);
    HapticLoop other(twin, twin_def);
    make_loop(open(pressing_hand()));
    EXPECT_EQ(status().warning_count, other.warnings().size());
    if (start) {
      ASSERT_OK(crumble_loop_start(loop));
      other.start();
    }
    double most = 0;
    for (int k = 0; k < 2000; ++k) {
      tick();
      other.tick();
      const HandStatus expected = other.status().hands[0];
      const crumble_hand_status got = hand();
      ASSERT_EQ(got.state, static_cast<std::uint32_t>(expected.state)) << k;
      for (int axis = 0; axis < 3; ++axis) ASSERT_EQ(got.force[axis], expected.force[axis]) << k;
      ASSERT_EQ(got.tool_pose.position[1], expected.tool.position.y());
      ASSERT_EQ(got.absorbed, expected.energy.absorbed);
      most = std::max(most, got.force[1]);
    }
    EXPECT_GT(most, 0.1);
    ASSERT_OK(crumble_loop_stop(loop));
    EXPECT_EQ(hash(), twin.state_hash());
    EXPECT_EQ(status().steps, other.status().steps);
    EXPECT_EQ(status().ticks, 2000u);
  }
  std::function<void(HandDef&)> change = [](HandDef&) {};
};

TEST_F(SameBits, Direct) {
  expect_like({}, false);
}

TEST_F(SameBits, ALocalModelThatWasStarted) {
  def.tau = 3e-3;
  ASSERT_OK(crumble_sim_configure(sim, &def));
  loop_def.coupling = CRUMBLE_COUPLING_LOCAL_MODEL;
  loop_def.body_ticks = 3;
  LoopDef local;
  local.coupling = BodyCoupling::local_model;
  local.body_ticks = 3;
  expect_like(local, true);
}

TEST_F(SameBits, EveryFieldOfAHandCounts) {
  hand_def.workspace_scale = 1.1, hand_def.force_gain = 0.8;
  hand_def.coupling_stiffness = 300, hand_def.controller = 1, hand_def.delay = 2, hand_def.max_damping = 0.7;
  hand_def.energy_credit = 1e-6, hand_def.max_force = 0.5, hand_def.max_slew = 20, hand_def.ramp_time = 0.1;
  hand_def.good_samples = 50, hand_def.max_speed = 0.5, hand_def.max_jump = 0.002, hand_def.max_torque = 0.01;
  hand_def.workspace_margin = 0.02;
  hand_def.workspace.orientation[0] = 0.96, hand_def.workspace.orientation[2] = 0.28;
  hand_def.workspace_mount[0] = 0.96, hand_def.workspace_mount[2] = -0.28;
  change = [](HandDef& hand) {
    hand.workspace.scale = 1.1, hand.workspace.force_gain = 0.8;
    hand.coupling.stiffness = 300;
    hand.passivity = {
        .inject_damping = true, .delay = 2, .max_damping = 0.7, .controller = true, .energy_credit = 1e-6};
    hand.safety = {0.5, 0.01, 0.5, 0.002, 20, 0.1, 50, 0.02};
    hand.workspace.pose.orientation = Quat(0.96, 0, 0.28, 0);
    hand.workspace.mount = Quat(0.96, 0, -0.28, 0);
  };
  expect_like({}, false);
}

TEST_F(SameBits, ThePaper) {
  ASSERT_OK(crumble_loop_apply_paper_preset(&loop_def, &hand_def, 1));
  EXPECT_EQ(loop_def.coupling, std::uint32_t{CRUMBLE_COUPLING_PAPER});
  EXPECT_EQ(loop_def.driver, std::uint32_t{CRUMBLE_DRIVER_HOST}) << "the rest stays";
  EXPECT_EQ(hand_def.coupling, 0u);
  EXPECT_EQ(hand_def.inject_damping, 0u);
  LoopDef paper;
  paper.hands.resize(1);
  apply_paper_preset(paper);
  change = [](HandDef& hand) { hand.coupling.enabled = hand.passivity.inject_damping = false; };
  expect_like(paper, false);
}

TEST_F(Loops, AHandThatFailsGetsAFaultAndNoForceUntilItIsReset) {
  make_loop(strings.open());
  press();
  strings.fails_at = strings.reads.load(), strings.answer = 1234;
  tick();
  EXPECT_EQ(strings.last_force, 0);
  EXPECT_EQ(hand().state, std::uint32_t{CRUMBLE_HAND_FAULTED});
  EXPECT_EQ(hand().fault, std::uint32_t{CRUMBLE_FAULT_DEVICE_LOST});
  EXPECT_EQ(hand().callback_error, 1234);
  EXPECT_EQ(hand().faults, 1u);
  EXPECT_STREQ(crumble_fault_name(hand().fault), "device_lost");
  tick(50);
  ASSERT_OK(crumble_loop_reset_fault(loop, 0));
  tick(50);
  EXPECT_EQ(hand().fault, std::uint32_t{CRUMBLE_FAULT_DEVICE_LOST}) << "it is lost for good";
  EXPECT_EQ(strings.last_force, 0);
  ASSERT_OK(crumble_loop_stop(loop));
}

TEST_F(Loops, AFaultIsResetAndTheForceComesBack) {
  make_loop(strings.open());
  press();
  ASSERT_OK(crumble_loop_halt(loop));
  tick();
  EXPECT_EQ(strings.last_force, 0);
  EXPECT_EQ(hand().fault, std::uint32_t{CRUMBLE_FAULT_HALTED});
  tick(100);
  EXPECT_EQ(strings.last_force, 0);
  ASSERT_OK(crumble_loop_reset_fault(loop, 0));
  strings.height = 0.002;  // farther than max_jump from where it was, which is forgotten
  press();
  EXPECT_EQ(hand().fault, std::uint32_t{CRUMBLE_FAULT_NONE});
  ASSERT_OK(crumble_loop_stop(loop));
  EXPECT_EQ(strings.last_force, 0);
}

TEST_F(Loops, StopAndDestroySendZeroAlsoAfterTicksWithoutStart) {
  make_loop(strings.open());
  press();
  ASSERT_OK(crumble_loop_destroy(loop));
  loop = nullptr;
  EXPECT_EQ(strings.last_force, 0);
  ASSERT_OK(crumble_device_destroy(device));
  device = nullptr;
  const crumble_pose pose = pose_at(0);
  EXPECT_RESULT(CRUMBLE_OK, crumble_sim_step(sim, &pose, &wrench));
}

TEST_F(Loops, CustomDevicesDoNotBypassTheSafetyStages) {
  hand_def.max_force = 0.02, hand_def.max_jump = 0.002, hand_def.max_speed = 10;
  make_loop(strings.open());
  tick(800);
  for (int i = 0; i < 500; ++i) strings.height = 0.002 - 1e-5 * i, tick();
  EXPECT_LE(strings.last_force, 0.02 * (1 + 1e-12));
  EXPECT_GT(hand().clamped, 0u);
  EXPECT_EQ(hand().held, 0u);
  strings.height = strings.height + 0.003;
  tick();
  EXPECT_EQ(hand().held, 1u);
  strings.height = strings.height - 0.003;
  tick();
  EXPECT_EQ(hand().fault, std::uint32_t{CRUMBLE_FAULT_NONE});
  strings.height = 1;  // twice a jump of a metre
  tick(2);
  EXPECT_EQ(hand().fault, std::uint32_t{CRUMBLE_FAULT_SPEED});
  ASSERT_OK(crumble_loop_stop(loop));
}

TEST_F(Loops, TheClutchIsAButton) {
  hand_def.clutch_buttons = 2;
  make_loop(strings.open());
  press();
  strings.buttons = 3;
  tick();
  EXPECT_EQ(hand().state, std::uint32_t{CRUMBLE_HAND_CLUTCHED});
  EXPECT_EQ(hand().buttons, 3u);
  EXPECT_EQ(strings.last_force, 0);
  ASSERT_OK(crumble_loop_stop(loop));
}

TEST_F(Loops, TwoHandsAndAToolThatIsPlaced) {
  ASSERT_OK(crumble_sim_add_tool(sim, &tool, nullptr));
  ASSERT_OK(crumble_sim_add_tool(sim, &tool, nullptr));
  Strings first, second;
  crumble_hand_def hands[2] = {hand_def, hand_def};
  hands[0].device = first.open(), hands[1].device = second.open();
  hands[0].tool = 2, hands[1].tool = 0;
  hands[0].workspace.position[0] = -0.007, hands[1].workspace.position[0] = 0.007;
  ASSERT_OK(crumble_loop_create(sim, &loop_def, hands, 2, &loop));
  const crumble_pose away = {{0, 0.2, 0}, {1, 0, 0, 0}};
  expect_failure(CRUMBLE_E_STATE, crumble_loop_place(loop, 0, &away), {"crumble_loop_place", "0"});
  expect_failure(CRUMBLE_E_OUT_OF_RANGE, crumble_loop_place(loop, 3, &away), {"3"});
  const crumble_pose bad = {{0, 0.2, 0}, {0, 0, 0, 0}};
  EXPECT_RESULT(CRUMBLE_E_BAD_POSE, crumble_loop_place(loop, 1, &bad));
  EXPECT_RESULT(CRUMBLE_E_NULL, crumble_loop_place(loop, 1, nullptr));
  ASSERT_OK(crumble_loop_place(loop, 1, &away));
  second.height = 0.004;
  tick(700);
  for (int i = 0; i < 300; ++i) first.height = 0.002 - 1e-5 * i, tick();
  EXPECT_GT(first.last_force, 0.01);
  EXPECT_EQ(second.last_force, 0);
  EXPECT_EQ(status().hand_count, 2u);
  EXPECT_NEAR(hand(0).tool_pose.position[0], -0.007, 1e-3);
  EXPECT_NEAR(hand(1).tool_pose.position[1], 0.038, 1e-15);
  EXPECT_GT(counters().suspended_steps, 0u) << "while they wait";
  ASSERT_OK(crumble_loop_destroy(loop));
  loop = nullptr;
  EXPECT_RESULT(CRUMBLE_OK, crumble_device_destroy(hands[0].device));
  EXPECT_RESULT(CRUMBLE_OK, crumble_device_destroy(hands[1].device));
}

TEST_F(Loops, ARecordingGoesOn) {
  const std::string path = testing::TempDir() + "crumble_loop.rec";
  make_loop(open(pressing_hand()));
  ASSERT_OK(crumble_sim_begin_recording(sim));
  tick(300);  // without start
  ASSERT_OK(crumble_loop_start(loop));
  tick(1000);
  ASSERT_OK(crumble_loop_stop(loop));
  const crumble_pose pose = pose_at(0);
  ASSERT_OK(crumble_sim_step(sim, &pose, &wrench));  // by hand again
  ASSERT_OK(crumble_sim_save_recording(sim, path.c_str()));
  ASSERT_OK(crumble_sim_end_recording(sim));
  tick(10);  // not recorded, and nobody minds
  std::uint64_t steps = 0, equal = 0;
  ASSERT_OK(crumble_verify_recording(path.c_str(), &steps, &equal));
  EXPECT_EQ(steps, 1301u);
  EXPECT_EQ(equal, 1301u);
  std::remove(path.c_str());
}

}  // namespace
}  // namespace crumble
