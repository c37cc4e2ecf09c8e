// What a host reads from a body and does to it: contacts, local model, forces on nodes.
#include <cmath>
#include <cstring>
#include <filesystem>

#include "capi/rig.hpp"
#include "crumble/base/memory.hpp"
#include "crumble/sim/local_model.hpp"
#include "support/allocation_counter.hpp"

namespace crumble {
namespace {

class Host : public CapiTest {
 protected:
  Vector<crumble_contact> contacts() {
    std::uint32_t count = 0;
    EXPECT_RESULT(CRUMBLE_OK, crumble_sim_get_contacts(sim, nullptr, 0, &count));
    Vector<crumble_contact> list(count);
    EXPECT_RESULT(CRUMBLE_OK, crumble_sim_get_contacts(sim, list.data(), count, &count));
    return list;
  }
  crumble_local_model model() {
    crumble_local_model value;
    EXPECT_RESULT(CRUMBLE_OK, crumble_sim_get_local_model(sim, 0, &value));
    return value;
  }
  /// The same press in C++.
  Simulation twin(int last) const {
    SimulationDef d;
    d.mesh = cube.mesh;
    d.material.length_limit = def.length_limit;
    d.fixed_nodes = nodes_below(d.mesh, 1e-6);
    d.tools.push_back({make_round_stick(0.004, 0.05, 16), {3, 1.5}, {}});
    Simulation made(std::move(d));
    for (int step = 1; step <= last; ++step) {
      const crumble_pose pose = pose_at(step);
      const Pose to{{pose.position[0], pose.position[1], pose.position[2]}, Quat(0.8, 0, 0.6, 0)};
      made.step({&to, 1});
    }
    return made;
  }
};

TEST_F(Host, ContactsCarryTheForceOfTheTool) {
  EXPECT_TRUE(contacts().empty());
  press(1, 300);
  double force[3] = {0, 0, 0}, size = 0;
  for (const crumble_contact& c : contacts()) {
    EXPECT_LT(c.node, cube.node_count());
    EXPECT_LE(c.state, std::uint32_t{CRUMBLE_HELD_SLIDING});
    EXPECT_EQ(c.reserved, 0u);
    EXPECT_NEAR(std::hypot(c.normal[0], c.normal[1], c.normal[2]), 1, 1e-12);
    if (c.holder == CRUMBLE_NONE) continue;
    EXPECT_EQ(c.holder, 0u);
    for (int axis = 0; axis < 3; ++axis) force[axis] -= c.reaction[axis], size += std::abs(c.reaction[axis]);
  }
  EXPECT_GT(size, 0.1);
  for (int axis = 0; axis < 3; ++axis) EXPECT_NEAR(force[axis], wrench.force[axis], 1e-12 * size);
}

TEST_F(Host, ContactsIntoTooSmallABufferTellTheCount) {
  press(1, 300);
  const auto there = static_cast<std::uint32_t>(contacts().size());
  ASSERT_GT(there, 2u);
  Vector<crumble_contact> list(there);
  list[0].node = 12345;
  std::uint32_t count = 0;
  expect_failure(CRUMBLE_E_BUFFER_TOO_SMALL, crumble_sim_get_contacts(sim, list.data(), there - 1, &count),
                 {"crumble_sim_get_contacts", "capacity", std::to_string(there)});
  EXPECT_EQ(count, there);
  EXPECT_EQ(list[0].node, 12345u);
  expect_failure(CRUMBLE_E_NULL, crumble_sim_get_contacts(sim, list.data(), there, nullptr), {"count"});
}

TEST_F(Host, LocalModelIsThatOfTheCxxLibrary) {
  press(1, 300);
  const crumble_local_model got = model();
  const Simulation same = twin(300);
  const LocalModel expected = same.local_model(0);
  EXPECT_GT(expected.contacts, 4u);
  EXPECT_EQ(got.contact_count, expected.contacts);
  EXPECT_EQ(got.listed, expected.listed);
  EXPECT_EQ(got.radius, expected.radius);
  EXPECT_EQ(got.held_drag, expected.held_drag);
  EXPECT_EQ(got.fracture, std::uint32_t{expected.fracture});
  for (int i = 0; i < 36; ++i) EXPECT_EQ(got.jacobian[i], expected.jacobian[static_cast<std::size_t>(i)]);
  for (int i = 0; i < 9; ++i) EXPECT_EQ(got.stiffness[i], expected.stiffness(i / 3, i % 3));
  for (int axis = 0; axis < 3; ++axis) {
    EXPECT_EQ(got.at.position[axis], pose_at(300).position[axis]);
    EXPECT_EQ(got.wrench.force[axis], expected.wrench.force[axis]);
    EXPECT_EQ(got.wrench.torque[axis], expected.wrench.torque[axis]);
  }
  double drag = 0;
  ASSERT_OK(crumble_sim_get_held_drag(sim, 0, &drag));
  EXPECT_EQ(drag, got.held_drag);

  crumble_pose there = got.at;
  there.position[1] += 1e-4;
  crumble_wrench value;
  ASSERT_OK(crumble_local_model_evaluate(&got, &there, &value));
  Pose pose = expected.at;
  pose.position.y() += 1e-4;
  const Wrench due = evaluate(expected, pose);
  for (int axis = 0; axis < 3; ++axis) {
    EXPECT_EQ(value.force[axis], due.force[axis]);
    EXPECT_EQ(value.torque[axis], due.torque[axis]);
  }
  EXPECT_LT(value.force[1], got.wrench.force[1]);
}

TEST_F(Host, LocalModelRefusals) {
  press(1, 200);
  const crumble_local_model good = model();
  crumble_local_model value = good;
  expect_failure(CRUMBLE_E_OUT_OF_RANGE, crumble_sim_get_local_model(sim, 1, &value), {"tool is 1"});
  EXPECT_EQ(std::memcmp(&value, &good, sizeof good), 0);
  expect_failure(CRUMBLE_E_NULL, crumble_sim_get_local_model(sim, 0, nullptr), {"model"});
  double drag = 7;
  expect_failure(CRUMBLE_E_OUT_OF_RANGE, crumble_sim_get_held_drag(sim, 1, &drag), {"tool is 1"});
  EXPECT_EQ(drag, 7);
  expect_failure(CRUMBLE_E_NULL, crumble_sim_get_held_drag(sim, 0, nullptr), {"drag"});

  const auto refused = [&](crumble_result code, const crumble_local_model* from, const crumble_pose* pose,
                           const std::string& word) {
    crumble_wrench pushed{{1, 1, 1}, {1, 1, 1}};
    expect_failure(code, crumble_local_model_evaluate(from, pose, &pushed), {"crumble_local_model_evaluate", word});
    for (int axis = 0; axis < 3; ++axis) EXPECT_EQ(std::abs(pushed.force[axis]) + std::abs(pushed.torque[axis]), 0);
  };
  refused(CRUMBLE_E_NULL, nullptr, &good.at, "model");
  refused(CRUMBLE_E_NULL, &good, nullptr, "pose");
  crumble_pose bad = good.at;
  bad.position[2] = kNan;
  refused(CRUMBLE_E_BAD_POSE, &good, &bad, "pose");
  bad = good.at;
  bad.orientation[0] = 2;
  refused(CRUMBLE_E_BAD_POSE, &good, &bad, "pose");
  value = good;
  value.listed = CRUMBLE_LOCAL_CONTACTS + 1;
  refused(CRUMBLE_E_OUT_OF_RANGE, &value, &good.at, "listed");
  value = crumble_local_model{};  // never filled
  refused(CRUMBLE_E_BAD_POSE, &value, &good.at, "model.at");
  expect_failure(CRUMBLE_E_NULL, crumble_local_model_evaluate(&good, &good.at, nullptr), {"wrench"});
}

TEST_F(Host, ReadingTakesNoMemory) {
  if (!AllocationCounter::available()) GTEST_SKIP() << "a sanitizer owns malloc";
  press(1, 300);
  Vector<crumble_contact> list(cube.node_count());
  crumble_local_model value;
  std::uint32_t count = 0;
  const double force[3] = {0, 0.001, 0};
  const AllocationCounter counter;
  crumble_sim_get_contacts(sim, list.data(), cube.node_count(), &count);
  crumble_sim_get_local_model(sim, 0, &value);
  crumble_local_model_evaluate(&value, &value.at, &wrench);
  crumble_sim_set_node_force(sim, 5, force);
  EXPECT_EQ(counter.count(), 0u);
  EXPECT_GT(count, 0u);
}

TEST_F(Host, NodeForcesAreKeptRecordedAndTakenBack) {
  const std::uint64_t at_rest = hash();
  const auto path = std::filesystem::temp_directory_path() / "crumble_node_forces.crec";
  Vector<double> forces(3 * cube.node_count(), 0.0);
  for (std::size_t i = 0; i < forces.size(); i += 7) forces[i] = 1e-4 * static_cast<double>(i % 11);
  ASSERT_OK(crumble_sim_begin_recording(sim));
  press(1, 20);
  ASSERT_OK(crumble_sim_set_node_forces(sim, forces.data(), cube.node_count()));
  press(21, 120);
  const double one[3] = {0, 0, 0.01};
  ASSERT_OK(crumble_sim_set_node_force(sim, cube.node_count() - 1, one));
  press(121, 200);
  ASSERT_OK(crumble_sim_set_node_forces(sim, nullptr, 0));
  press(201, 260);
  ASSERT_OK(crumble_sim_save_recording(sim, path.string().c_str()));
  ASSERT_OK(crumble_sim_end_recording(sim));
  std::uint64_t steps = 0, equal = 0;
  ASSERT_OK(crumble_verify_recording(path.string().c_str(), &steps, &equal));
  std::filesystem::remove(path);
  EXPECT_EQ(steps, 260u);
  EXPECT_EQ(equal, 260u);
  ASSERT_OK(crumble_sim_set_node_force(sim, 0, one));
  ASSERT_OK(crumble_sim_reset(sim));
  EXPECT_EQ(hash(), at_rest);
}

TEST_F(Host, NodeForcesRefusals) {
  press(1, 100);
  const std::uint64_t before = hash();
  Vector<double> forces(3 * cube.node_count(), 0.0);
  forces[3 * 17 + 1] = kNan;
  expect_failure(CRUMBLE_E_INVALID_VALUE, crumble_sim_set_node_forces(sim, forces.data(), cube.node_count()),
                 {"crumble_sim_set_node_forces", "node 17"});
  expect_failure(CRUMBLE_E_OUT_OF_RANGE, crumble_sim_set_node_forces(sim, forces.data(), cube.node_count() - 1),
                 {"count", std::to_string(cube.node_count())});
  expect_failure(CRUMBLE_E_NULL, crumble_sim_set_node_forces(sim, nullptr, cube.node_count()), {"forces"});
  const double bad[3] = {0, kInfinity, 0}, good[3] = {0, 1, 0};
  expect_failure(CRUMBLE_E_INVALID_VALUE, crumble_sim_set_node_force(sim, 3, bad), {"node 3"});
  expect_failure(CRUMBLE_E_OUT_OF_RANGE, crumble_sim_set_node_force(sim, cube.node_count(), good), {"node is"});
  expect_failure(CRUMBLE_E_NULL, crumble_sim_set_node_force(sim, 3, nullptr), {"force"});
  EXPECT_EQ(hash(), before);
}

}  // namespace
}  // namespace crumble
