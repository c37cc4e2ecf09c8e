// Changes in mid-run, several steps at once, the books, recordings looked at step by step.
#include <filesystem>
#include <fstream>

#include "capi/rig.hpp"

namespace crumble {
namespace {

class Live : public CapiTest {
 protected:
  double force() { return wrench.force[1]; }
};

TEST_F(Live, MaterialChangesBetweenSteps) {
  press(1, 60);
  const double soft = force();
  ASSERT_GT(soft, 0.01);
  ASSERT_OK(crumble_sim_get_def(sim, &def));
  def.stiffness = 60;
  def.gravity[0] = 1;
  ASSERT_OK(crumble_sim_configure(sim, &def));
  press(61, 61);
  EXPECT_NEAR(force() / soft, 2, 0.3);
  crumble_sim_def now{};
  now.struct_size = sizeof now;
  ASSERT_OK(crumble_sim_get_def(sim, &now));
  EXPECT_EQ(now.stiffness, 60);
  EXPECT_EQ(now.gravity[0], 1);
  EXPECT_EQ(info().step, 61u);
}

TEST_F(Live, ADefinitionThatStaysTheSameChangesNoBit) {
  press(1, 150);
  ASSERT_GT(counters().cuts, 0u);
  const std::uint64_t here = hash();
  ASSERT_OK(crumble_sim_get_def(sim, &def));
  ASSERT_OK(crumble_sim_configure(sim, &def));
  ASSERT_OK(crumble_sim_set_tool(sim, 0, &tool));
  ASSERT_OK(crumble_sim_set_friction(sim, 0, tool.static_friction, tool.dynamic_friction));
  ASSERT_OK(crumble_sim_fix_below(sim, 1e-6));
  EXPECT_EQ(hash(), here);
  press(151, 200);
  const std::uint64_t changed = hash();
  crumble_sim never = make_sim();
  std::swap(sim, never);
  press(1, 200);
  EXPECT_EQ(hash(), changed);
  ASSERT_OK(crumble_sim_destroy(never));
}

TEST_F(Live, ToolsWallsAndFloorCome) {
  press(1, 40);
  crumble_tool_def ball = tool;
  ball.shape = CRUMBLE_TOOL_BALL;
  ASSERT_OK(crumble_sim_set_tool(sim, 0, &ball));
  press(41, 41);
  EXPECT_EQ(force(), 0) << "another solid lets go";
  EXPECT_TRUE(info().flags & CRUMBLE_STEP_CONTACT_SUSPENDED);
  crumble_wall_def wall{};
  ASSERT_OK(crumble_wall_def_init(&wall, sizeof wall));
  wall.offset = -0.001;
  ASSERT_OK(crumble_sim_add_wall(sim, &wall));
  wall.offset = 0.001;  // lifts the loose part of the bottom
  ASSERT_OK(crumble_sim_set_wall(sim, 1, &wall));
  ASSERT_OK(crumble_sim_get_def(sim, &def));
  def.floor = 0;
  ASSERT_OK(crumble_sim_configure(sim, &def));
  press(42, 43);
  expect_failure(CRUMBLE_E_OUT_OF_RANGE, crumble_sim_set_wall(sim, 1, &wall), {"wall is 1", "there are 1"});
}

TEST_F(Live, ARecordingKeepsTheChange) {
  press(1, 30);
  ASSERT_OK(crumble_sim_begin_recording(sim));
  press(31, 60);
  ASSERT_OK(crumble_sim_get_def(sim, &def));
  def.stiffness = 20;
  ASSERT_OK(crumble_sim_configure(sim, &def));
  ASSERT_OK(crumble_sim_set_friction(sim, 0, 0.5, 0.2));
  press(61, 120);
  const auto path = (std::filesystem::temp_directory_path() / "crumble_live_test.crec").string();
  ASSERT_OK(crumble_sim_save_recording(sim, path.c_str()));
  ASSERT_OK(crumble_sim_end_recording(sim));
  std::uint64_t steps = 0, equal = 0;
  ASSERT_OK(crumble_verify_recording(path.c_str(), &steps, &equal));
  EXPECT_EQ(steps, 90u);
  EXPECT_EQ(equal, 90u);

  // and step by step
  crumble_recording recording = nullptr;
  ASSERT_OK(crumble_recording_load(path.c_str(), &recording));
  std::filesystem::remove(path);
  crumble_recording_info about{};
  about.struct_size = sizeof about;
  ASSERT_OK(crumble_recording_get_info(recording, &about));
  EXPECT_EQ(about.tool_count, 1u);
  EXPECT_EQ(about.step_count, 90u);
  EXPECT_EQ(about.first_step, 30u);
  crumble_sim again = nullptr;
  ASSERT_OK(crumble_recording_create_sim(recording, &again));
  for (std::uint64_t step = 0; step < 90; ++step) {
    std::uint32_t same = 0;
    ASSERT_OK(crumble_recording_step(recording, again, step, &same));
    ASSERT_EQ(same, 1u) << step;
  }
  std::uint64_t reached = 0;
  ASSERT_OK(crumble_sim_state_hash(again, &reached));
  EXPECT_EQ(reached, hash());
  ASSERT_OK(crumble_sim_get_def(again, &def));
  EXPECT_EQ(def.stiffness, 20);
  EXPECT_EQ(def.floor, 1u);
  std::uint32_t same = 1;
  ASSERT_OK(crumble_recording_step(recording, again, 3, &same));  // not from where step 2 left it
  EXPECT_EQ(same, 0u);
  expect_failure(CRUMBLE_E_OUT_OF_RANGE, crumble_recording_step(recording, again, 90, &same), {"step is 90", "90"});
  ASSERT_OK(crumble_sim_destroy(again));
  EXPECT_RESULT(CRUMBLE_E_STALE_HANDLE, crumble_recording_step(recording, again, 0, nullptr));
  ASSERT_OK(crumble_recording_destroy(recording));
  EXPECT_RESULT(CRUMBLE_E_STALE_HANDLE, crumble_recording_get_info(recording, &about));
  EXPECT_RESULT(CRUMBLE_E_IO, crumble_recording_load(path.c_str(), &recording));
}

TEST_F(Live, WhatCannotChangeIsSaidAndNothingChanges) {
  press(1, 20);
  const std::uint64_t before = hash();
  ASSERT_OK(crumble_sim_get_def(sim, &def));
  const crumble_sim_def good = def;
  def.tau = 0.002;
  expect_failure(CRUMBLE_E_STATE, crumble_sim_configure(sim, &def), {"crumble_sim_configure", "tau is 0.001", "0.002"});
  def = good, def.precision = CRUMBLE_PRECISION_FLOAT32;
  expect_failure(CRUMBLE_E_STATE, crumble_sim_configure(sim, &def), {"precision"});
  def = good, def.stiffness = kNan;
  expect_failure(CRUMBLE_E_INVALID_VALUE, crumble_sim_configure(sim, &def), {"stiffness"});
  expect_failure(CRUMBLE_E_STATE, crumble_sim_apply_paper_preset(sim), {"tau"});
  expect_failure(CRUMBLE_E_STATE, crumble_sim_add_tool(sim, &tool, nullptr), {"20 steps"});
  expect_failure(CRUMBLE_E_OUT_OF_RANGE, crumble_sim_set_tool(sim, 1, &tool), {"tool is 1", "there are 1"});
  expect_failure(CRUMBLE_E_OUT_OF_RANGE, crumble_sim_set_friction(sim, 0, 1, 2), {"friction"});
  tool.radius = -1;
  expect_failure(CRUMBLE_E_OUT_OF_RANGE, crumble_sim_set_tool(sim, 0, &tool), {"radius"});
  EXPECT_EQ(hash(), before);
  crumble_sim_def now{};
  now.struct_size = sizeof now;
  ASSERT_OK(crumble_sim_get_def(sim, &now));
  EXPECT_EQ(now.floor, 1u);
  EXPECT_EQ(now.tau, 0.001);
}

TEST_F(Live, SeveralStepsInOneCall) {
  press(1, 30);
  crumble_sim other = make_sim();
  std::swap(sim, other);
  press(1, 30);
  const crumble_pose target{{6e-5, 0.034 - 9e-4, 0}, {0.8, 0, 0.6, 0}};
  crumble_wrench mean{};
  crumble_advance_info done{};
  done.struct_size = sizeof done;
  ASSERT_OK(crumble_sim_advance(sim, &target, &mean, 1, 16, 0, &done));
  EXPECT_EQ(done.steps, 16u);
  EXPECT_EQ(done.dropped, 0u);
  EXPECT_NEAR(done.time, 0.046, 1e-9);
  EXPECT_GT(done.seconds, 0);
  EXPECT_GT(mean.force[1], 0.01);
  const crumble_pose from = pose_at(30);
  for (int k = 1; k <= 16; ++k) {
    crumble_pose here = target;
    for (int axis = 0; k < 16 && axis < 3; ++axis) {
      here.position[axis] = from.position[axis] + (target.position[axis] - from.position[axis]) * (k / 16.0);
    }
    ASSERT_OK(crumble_sim_step(other, &here, &wrench));
  }
  crumble_view mine{}, theirs{};
  ASSERT_OK(crumble_sim_get_view(sim, CRUMBLE_ARRAY_POSITIONS_Y, &mine));
  ASSERT_OK(crumble_sim_get_view(other, CRUMBLE_ARRAY_POSITIONS_Y, &theirs));
  for (std::uint64_t i = 0; i < mine.count; ++i) {
    ASSERT_NEAR(static_cast<const double*>(mine.data)[i], static_cast<const double*>(theirs.data)[i], 1e-9);
  }
  ASSERT_OK(crumble_sim_advance(sim, &target, &mean, 1, 50, 1e-9, &done));
  EXPECT_EQ(done.steps, 1u);
  EXPECT_EQ(done.dropped, 49u);
  EXPECT_TRUE(done.flags & CRUMBLE_STEP_DROPPED);
  EXPECT_EQ(counters().dropped_steps, 49u);
  ASSERT_OK(crumble_sim_destroy(other));
}

TEST_F(Live, AdvanceIsRecordedStepByStepAndRefusesNonsense) {
  ASSERT_OK(crumble_sim_begin_recording(sim));
  crumble_pose pose = pose_at(0);
  for (int frame = 1; frame <= 5; ++frame) {
    pose = pose_at(20 * frame);
    ASSERT_OK(crumble_sim_advance(sim, &pose, &wrench, 1, 20, 0, nullptr));
  }
  const auto path = (std::filesystem::temp_directory_path() / "crumble_advance_test.crec").string();
  ASSERT_OK(crumble_sim_save_recording(sim, path.c_str()));
  std::uint64_t steps = 0, equal = 0;
  ASSERT_OK(crumble_verify_recording(path.c_str(), &steps, &equal));
  std::filesystem::remove(path);
  EXPECT_EQ(steps, 100u);
  EXPECT_EQ(equal, 100u);

  const auto refused = [&](crumble_result expected, std::uint32_t tools, std::uint32_t count, double budget,
                           const Vector<std::string>& words) {
    crumble_wrench old{{1, 1, 1}, {1, 1, 1}};
    expect_failure(expected, crumble_sim_advance(sim, &pose, &old, tools, count, budget, nullptr), words);
    EXPECT_EQ(old.force[0], 0);
  };
  refused(CRUMBLE_E_OUT_OF_RANGE, 1, 0, 0, {"crumble_sim_advance", "steps", "0"});
  refused(CRUMBLE_E_OUT_OF_RANGE, 1, 100001, 0, {"steps", "100001"});
  refused(CRUMBLE_E_OUT_OF_RANGE, 1, 3, -1, {"budget", "-1"});
  refused(CRUMBLE_E_INVALID_VALUE, 1, 3, kNan, {"budget"});
  pose.position[2] = kInfinity;
  refused(CRUMBLE_E_BAD_POSE, 1, 3, 0, {"pose 0", "position[2]"});
  pose.position[2] = 0;
  crumble_advance_info info_of_no_size{};
  EXPECT_RESULT(CRUMBLE_E_UNINITIALIZED, crumble_sim_advance(sim, &pose, &wrench, 1, 3, 0, &info_of_no_size));
  EXPECT_RESULT(CRUMBLE_E_NULL, crumble_sim_advance(sim, nullptr, &wrench, 1, 3, 0, nullptr));
  EXPECT_RESULT(CRUMBLE_E_NULL, crumble_sim_advance(sim, &pose, nullptr, 1, 3, 0, nullptr));
}

TEST_F(Live, TheBooksAreKeptWhenAskedFor) {
  crumble_energy energy{};
  energy.struct_size = sizeof energy;
  expect_failure(CRUMBLE_E_STATE, crumble_sim_get_energy(sim, &energy), {"energy_audit"});
  ASSERT_OK(crumble_sim_destroy(sim));
  def.energy_audit = 1;
  sim = make_sim();
  press(1, 150);
  ASSERT_OK(crumble_sim_get_energy(sim, &energy));
  EXPECT_GT(energy.tool_work, 0);
  EXPECT_GT(energy.cut, 0);
  EXPECT_NEAR(energy.tool_work + energy.external_work - energy.dissipated - energy.cut, energy.stored,
              1e-9 * energy.tool_work);
  EXPECT_LT(energy.gain_max_relative, 1e-12);
  def.energy_audit = 2;
  crumble_sim none = nullptr;
  expect_failure(CRUMBLE_E_OUT_OF_RANGE, crumble_sim_create(mesh, &def, &none), {"energy_audit"});
}

TEST_F(Live, AMeshIsSavedForOthersToRead) {
  const auto path = (std::filesystem::temp_directory_path() / "crumble_mesh_test.vtk").string();
  ASSERT_OK(crumble_mesh_save_vtk(mesh, path.c_str()));
  std::ifstream file(path);
  std::string all((std::istreambuf_iterator<char>(file)), {});
  std::filesystem::remove(path);
  EXPECT_NE(all.find("POINTS " + std::to_string(cube.node_count())), std::string::npos);
  EXPECT_NE(all.find("CELLS " + std::to_string(cube.tetrahedron_count())), std::string::npos);
  expect_failure(CRUMBLE_E_IO, crumble_mesh_save_vtk(mesh, "/nowhere/at/all.vtk"), {"/nowhere/at/all.vtk"});
  expect_failure(CRUMBLE_E_NULL, crumble_mesh_save_vtk(mesh, nullptr), {"path"});
}

}  // namespace
}  // namespace crumble
