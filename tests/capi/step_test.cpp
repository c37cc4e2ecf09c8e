// Steps through C: the numbers of the C++ API, and what a servo loop may rely on.
#include <cstring>

#include "capi/c_client.h"
#include "capi/rig.hpp"
#include "crumble/base/memory.hpp"
#include "crumble/bubblemesh/presets.hpp"
#include "support/allocation_counter.hpp"

namespace crumble {
namespace {

bool same_bits(const crumble_wrench& a, const Wrench& b) {
  return std::memcmp(a.force, b.force.data(), sizeof a.force) == 0 &&
         std::memcmp(a.torque, b.torque.data(), sizeof a.torque) == 0;
}

Pose to_cpp(const crumble_pose& pose) {
  const double *p = pose.position, *q = pose.orientation;
  return {{p[0], p[1], p[2]}, Quat(q[0], q[1], q[2], q[3])};
}

bool is_zero(const crumble_wrench& wrench) {
  const crumble_wrench zero{};
  return std::memcmp(&wrench, &zero, sizeof zero) == 0;
}

class Step : public CapiTest {
 protected:
  // The same simulation without C.
  SimulationDef twin_definition() const {
    SimulationDef twin;
    twin.mesh = cube.mesh;
    twin.material.length_limit = 1.1;
    twin.fixed_nodes = nodes_below(cube.mesh, 1e-6);
    twin.tools = {{make_round_stick(0.004, 0.05, 16), {3, 1.5}}};
    return twin;
  }
  // A pose that is wrong is answered so, and nothing moves.
  void expect_bad_pose(const crumble_pose& bad, const std::string& word) {
    const std::uint64_t refused = counters().bad_poses;
    const crumble_step_info before = info();
    wrench.force[1] = 99;
    expect_failure(CRUMBLE_E_BAD_POSE, crumble_sim_step(sim, &bad, &wrench), {"crumble_sim_step", word});
    EXPECT_TRUE(is_zero(wrench));
    EXPECT_EQ(counters().bad_poses, refused + 1);
    EXPECT_EQ(info().step, before.step);
    EXPECT_EQ(info().time, before.time);
    EXPECT_EQ(info().status, CRUMBLE_E_BAD_POSE);
  }
};

TEST_F(Step, HasTheBitsOfTheCppApi) {
  Simulation twin(twin_definition());
  for (int step = 1; step <= 300; ++step) {
    const crumble_pose pose = pose_at(step);
    const Pose same = to_cpp(pose);
    ASSERT_OK(crumble_sim_step(sim, &pose, &wrench));
    twin.step({&same, 1});
    ASSERT_TRUE(same_bits(wrench, twin.wrench(0))) << "step " << step;
  }
  EXPECT_EQ(hash(), twin.state_hash());
  EXPECT_GT(wrench.force[1], 0.1);
  EXPECT_NE(wrench.torque[1], 0);
  EXPECT_GT(counters().cuts, 20u);
  EXPECT_EQ(counters().cuts, twin.counters().cuts);
  EXPECT_EQ(info().step, 300u);
  EXPECT_EQ(info().time, twin.info().time);
  EXPECT_EQ(info().contacts, twin.info().contacts);
  EXPECT_GT(info().contacts, 0u);
  EXPECT_EQ(info().flags, twin.info().flags);
}

TEST_F(Step, HasTheBitsOfTheCppApiUnderThePaperPreset) {
  SimulationDef definition = twin_definition();
  apply_paper_preset(definition);
  ASSERT_OK(crumble_sim_apply_paper_preset(sim));
  Simulation twin(definition);
  for (int step = 1; step <= 100; ++step) {
    const crumble_pose pose = pose_at(3 * step);
    const Pose same = to_cpp(pose);
    ASSERT_OK(crumble_sim_step(sim, &pose, &wrench));
    twin.step({&same, 1});
    ASSERT_TRUE(same_bits(wrench, twin.wrench(0))) << "step " << step;
  }
  crumble_sim_def now{};
  now.struct_size = sizeof now;
  ASSERT_OK(crumble_sim_get_def(sim, &now));
  EXPECT_EQ(now.tau, 2.9e-3);
  EXPECT_EQ(now.time_step_policy, std::uint32_t{CRUMBLE_POLICY_UNCHECKED});
  EXPECT_EQ(now.contact_rule, std::uint32_t{CRUMBLE_CONTACT_ALONG_MOTION});
  EXPECT_EQ(now.mass_rule, std::uint32_t{CRUMBLE_MASS_EQUAL});
  EXPECT_EQ(now.cut_fade, 0);
  EXPECT_EQ(now.mean_force, 1u);
  EXPECT_EQ(now.gravity[1], 0);
  EXPECT_EQ(now.length_limit, 1.1);
}

TEST(PaperCube, IsTheSameFromPlainC) {
  crumble_mesh mesh = nullptr;
  ASSERT_OK(crumble_mesh_create_paper(CRUMBLE_PAPER_CUBE, &mesh));
  SimulationDef definition;
  definition.mesh = generate_paper_body(PaperBody::cube).mesh;
  definition.fixed_nodes = nodes_below(definition.mesh, 1e-6);
  definition.tools = {{make_round_stick(0.004, 0.05, 16), {}}};
  Simulation twin(definition);
  Pose pose;
  for (int step = 1; step <= 150; ++step) {
    pose.position.y() = 0.034 - 2e-5 * step;
    twin.step({&pose, 1});
  }
  EXPECT_EQ(c_press(mesh), twin.wrench(0).force.y());
  EXPECT_GT(twin.wrench(0).force.y(), 0.1);
  crumble_mesh_info info{};
  info.struct_size = sizeof info;
  ASSERT_OK(crumble_mesh_get_info(mesh, &info));
  EXPECT_EQ(info.surface_node_count, 306u);
  EXPECT_EQ(info.node_count, 600u);
  ASSERT_OK(crumble_mesh_destroy(mesh));
}

TEST_F(Step, EachToolHasItsOwnWrench) {
  crumble_tool_def bar = tool;
  bar.shape = CRUMBLE_TOOL_BAR;
  std::uint32_t index = 0;
  ASSERT_OK(crumble_sim_add_tool(sim, &bar, &index));
  EXPECT_EQ(index, 1u);
  SimulationDef definition = twin_definition();
  definition.tools.push_back({make_bar({0.006, 0.006, 0.05}), {3, 1.5}});
  Simulation twin(definition);
  crumble_pose poses[] = {{{-0.01, 0, 0}, {1, 0, 0, 0}}, {{0.01, 0, 0}, {1, 0, 0, 0}}};
  crumble_wrench wrenches[2];
  for (int step = 0; step < 50; ++step) {
    poses[0].position[1] = 0.034 - 5e-6 * step;
    poses[1].position[1] = 0.033 - 2e-5 * step;
    const Pose same[] = {to_cpp(poses[0]), to_cpp(poses[1])};
    ASSERT_OK(crumble_sim_step_tools(sim, poses, wrenches, 2));
    twin.step(same);
    ASSERT_TRUE(same_bits(wrenches[0], twin.wrench(0)));
    ASSERT_TRUE(same_bits(wrenches[1], twin.wrench(1)));
  }
  EXPECT_GT(wrenches[0].force[1], 0);
  EXPECT_GT(wrenches[1].force[1], wrenches[0].force[1]);

  // the form for one tool, or another number, is not for this simulation; it still leaves no old force behind
  expect_failure(CRUMBLE_E_OUT_OF_RANGE, crumble_sim_step(sim, poses, wrenches), {"crumble_sim_step", "1", "2"});
  EXPECT_TRUE(is_zero(wrenches[0]));
  EXPECT_RESULT(CRUMBLE_E_OUT_OF_RANGE, crumble_sim_step_tools(sim, nullptr, nullptr, 0));
  EXPECT_EQ(info().step, 50u);
}

TEST_F(Step, RefusesBadPosesWithoutForce) {
  press(1, 100);
  ASSERT_GT(wrench.force[1], 0);
  Vector<double> before(3 * cube.node_count()), after = before;
  ASSERT_OK(crumble_sim_copy(sim, CRUMBLE_ARRAY_POSITIONS, before.data(), before.size() * 8, nullptr));
  for (int i = 0; i < 3; ++i) {
    crumble_pose bad = pose_at(101);
    bad.position[i] = i == 2 ? kInfinity : kNan;
    expect_bad_pose(bad, "position[" + std::to_string(i) + "]");
  }
  for (int i = 0; i < 4; ++i) {
    crumble_pose bad = pose_at(101);
    bad.orientation[i] = kNan;
    expect_bad_pose(bad, "orientation");
  }
  crumble_pose bad = pose_at(101);
  bad.orientation[0] = 0.83;
  expect_bad_pose(bad, "0.83");
  bad = {{0, 0, 0}, {0, 0, 0, 0}};
  expect_bad_pose(bad, "orientation");
  ASSERT_OK(crumble_sim_copy(sim, CRUMBLE_ARRAY_POSITIONS, after.data(), after.size() * 8, nullptr));
  EXPECT_EQ(before, after);

  crumble_pose nearly = pose_at(101);
  for (double& q : nearly.orientation) q *= 1.0005;
  EXPECT_RESULT(CRUMBLE_OK, crumble_sim_step(sim, &nearly, &wrench));
  EXPECT_GT(wrench.force[1], 0);
}

TEST_F(Step, FailsWithoutForceWhateverIsWrong) {
  const crumble_pose pose = pose_at(1);
  crumble_sim gone = make_sim();
  ASSERT_OK(crumble_sim_destroy(gone));
  for (const auto& [handle, pointer] : {std::pair{crumble_sim{}, &pose}, {gone, &pose}, {sim, nullptr}}) {
    wrench.force[1] = 99;
    EXPECT_LT(crumble_sim_step(handle, pointer, &wrench), 0);
    EXPECT_TRUE(is_zero(wrench));
  }
}

TEST_F(Step, ADivergedBodyStandsStillUntilReset) {
  ASSERT_OK(crumble_sim_reset(sim));
  def.time_step_policy = CRUMBLE_POLICY_UNCHECKED;
  def.stiffness = 1e6;
  def.damping_ratio = 1e-3;
  def.length_limit = 1e6;
  ASSERT_OK(crumble_sim_configure(sim, &def));
  crumble_result result = CRUMBLE_OK;
  int step = 0;
  while (result == CRUMBLE_OK && step < 1000) {
    const crumble_pose pose = pose_at(++step);
    result = crumble_sim_step(sim, &pose, &wrench);
  }
  expect_failure(CRUMBLE_E_DIVERGED, result, {"crumble_sim_step", "node " + std::to_string(info().bad_node)});
  EXPECT_TRUE(is_zero(wrench));
  const std::uint64_t frozen = hash();
  const crumble_pose pose = pose_at(1);
  EXPECT_RESULT(CRUMBLE_E_DIVERGED, crumble_sim_step(sim, &pose, &wrench));
  EXPECT_EQ(hash(), frozen);
  ASSERT_OK(crumble_sim_reset(sim));
  EXPECT_RESULT(CRUMBLE_OK, crumble_sim_step(sim, &pose, &wrench));
}

TEST_F(Step, SaysWhenAToolJumpedOrBeganInside) {
  crumble_pose inside = pose_at(1);
  inside.position[1] = 0.015;
  ASSERT_OK(crumble_sim_step(sim, &inside, &wrench));
  EXPECT_TRUE(info().flags & CRUMBLE_STEP_CONTACT_SUSPENDED);
  EXPECT_TRUE(is_zero(wrench));
  ASSERT_OK(crumble_sim_reset(sim));
  press(1, 1);
  inside.position[0] = 1;
  ASSERT_OK(crumble_sim_step(sim, &inside, &wrench));
  EXPECT_TRUE(info().flags & CRUMBLE_STEP_TOOL_JUMPED);
  EXPECT_EQ(counters().tool_jumps, 1u);
}

TEST_F(Step, AllocatesNothing) {
  if (!AllocationCounter::available()) GTEST_SKIP() << "allocations are not counted here";
  std::size_t allocations = 0;
  bool fine = true;
  {
    const AllocationCounter counter;
    for (int step = 1; step <= 400; ++step) {
      crumble_pose pose = pose_at(step);
      fine = fine && crumble_sim_step(sim, &pose, &wrench) == CRUMBLE_OK;
      pose.position[0] = kNan;
      fine = fine && crumble_sim_step(sim, &pose, &wrench) == CRUMBLE_E_BAD_POSE;
    }
    crumble_step_info info{};
    info.struct_size = sizeof info;
    fine = fine && crumble_sim_get_step_info(sim, &info) == CRUMBLE_OK;
    allocations = counter.count();
  }
  EXPECT_TRUE(fine) << crumble_last_error();
  EXPECT_EQ(allocations, 0u);
  EXPECT_GT(counters().cuts, 40u);
}

TEST_F(Step, ProfilesItsStages) {
  press(1, 100);
  crumble_profile profile{};
  profile.struct_size = sizeof profile;
  ASSERT_OK(crumble_sim_get_profile(sim, &profile));
  EXPECT_GT(profile.solve_network, 0);
  EXPECT_LT(profile.solve_network, 1);
  EXPECT_GE(profile.finish_step, 0);
}

TEST_F(Step, WallsAndGravityAct) {
  def.floor = 0;
  ASSERT_OK(crumble_sim_configure(sim, &def));
  ASSERT_OK(crumble_sim_fix_nodes(sim, nullptr, 0));
  const crumble_pose away{{0, 1, 0}, {1, 0, 0, 0}};
  const auto lowest_after = [&](int steps) {
    for (int step = 0; step < steps; ++step) EXPECT_RESULT(CRUMBLE_OK, crumble_sim_step(sim, &away, &wrench));
    crumble_view view{};
    EXPECT_RESULT(CRUMBLE_OK, crumble_sim_get_view(sim, CRUMBLE_ARRAY_POSITIONS_Y, &view));
    const auto* const y = static_cast<const double*>(view.data);
    return *std::min_element(y, y + view.count);
  };
  EXPECT_LT(lowest_after(50), -1e-6);  // the floor is gone
  ASSERT_OK(crumble_sim_reset(sim));
  crumble_wall_def wall{};
  ASSERT_OK(crumble_wall_def_init(&wall, sizeof wall));
  wall.offset = 5e-4;  // lifts the body
  ASSERT_OK(crumble_sim_add_wall(sim, &wall));
  EXPECT_NEAR(lowest_after(50), 5e-4, 1e-9);
  ASSERT_OK(crumble_sim_reset(sim));
  def.floor = 1;
  ASSERT_OK(crumble_sim_configure(sim, &def));  // before the wall that was added ...
  def.floor = 0;
  ASSERT_OK(crumble_sim_configure(sim, &def));  // ... which stays when it goes
  EXPECT_NEAR(lowest_after(50), 5e-4, 1e-9);
}

}  // namespace
}  // namespace crumble
