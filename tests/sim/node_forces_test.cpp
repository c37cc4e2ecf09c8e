#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <functional>
#include <limits>
#include <string>

#include "crumble/sim/recording.hpp"
#include "crumble/tetmesh/lattice_box.hpp"

namespace crumble {
namespace {

SimulationDef cube() {
  SimulationDef def;
  def.mesh = make_lattice_box({0.03, 0.03, 0.03}, 0.01);
  def.gravity = Vec3::Zero();
  def.walls.clear();
  return def;
}

VecArray equal_forces(const Simulation& sim, const Vec3& force) {
  VecArray forces(sim.mesh().node_count());
  for (std::size_t node = 0; node < forces.size(); ++node) forces.set(node, force);
  return forces;
}

// The same bits as gravity, when each node gets its weight.
TEST(NodeForces, ThatAreTheWeightActLikeGravity) {
  SimulationDef def = cube();
  def.fixed_nodes = nodes_below(def.mesh, 1e-6);
  Simulation pushed(def);
  def.gravity = {0.5, -9.81, 0};
  Simulation heavy(def);
  VecArray forces(def.mesh.node_count());
  for (std::size_t node = 0; node < forces.size(); ++node) {
    forces.set(node, heavy.network().masses[node] * def.gravity);
  }
  pushed.set_node_forces(forces);
  for (int step = 0; step < 200; ++step) pushed.step({}), heavy.step({});
  for (std::size_t node = 0; node < forces.size(); ++node) {
    ASSERT_EQ(pushed.positions()[node], heavy.positions()[node]);
  }
  EXPECT_LT(pushed.positions().y[forces.size() - 1], 0.03);
}

// A sag under forces on top of the cube is carried by the fixed nodes: springs + forces of all nodes add up.
TEST(NodeForces, AreInTheBalanceOfForces) {
  SimulationDef def = cube();
  def.fixed_nodes = nodes_below(def.mesh, 1e-6);
  Simulation sim(def);
  const Vec3 force = {1e-3, -2e-3, 0};
  sim.set_node_forces(equal_forces(sim, force));
  for (int step = 0; step < 50; ++step) sim.step({});
  Vec3 sum = Vec3::Zero();
  const VecArray forces = sim.forces();
  for (std::size_t node = 0; node < forces.size(); ++node) sum += forces[node];
  const Vec3 due = static_cast<double>(forces.size()) * force;
  EXPECT_LE(norm(sum - due), 1e-12);
  EXPECT_EQ(sim.node_forces()[3], force);
}

TEST(NodeForces, DoExternalWork) {
  SimulationDef def = cube();
  def.step.energy_audit = true;
  def.fixed_nodes = nodes_below(def.mesh, 1e-6);
  Simulation sim(def);
  sim.set_node_forces(equal_forces(sim, {0, -2e-3, 1e-3}));
  for (int step = 0; step < 300; ++step) sim.step({});
  double work = 0;
  for (std::size_t node = 0; node < sim.positions().size(); ++node) {
    work += dot(Vec3(0, -2e-3, 1e-3), sim.positions()[node] - def.mesh.positions[node]);
  }
  EXPECT_GT(work, 1e-7);
  EXPECT_NEAR(sim.ledger().external_work, work, 1e-9 * work);
  EXPECT_LE(sim.ledger().gain_max_relative, 1e-12);
}

TEST(NodeForces, AreKeptUntilChangedOrReset) {
  Simulation sim(cube()), other(cube());
  const std::uint64_t at_rest = sim.state_hash();
  sim.set_node_force(7, {0, 1e-3, 0});
  EXPECT_NE(sim.state_hash(), at_rest);
  for (int step = 0; step < 20; ++step) sim.step({});
  other.restore(sim.snapshot());
  EXPECT_EQ(other.node_forces()[7], Vec3(0, 1e-3, 0));
  for (int step = 0; step < 20; ++step) {
    sim.step({}), other.step({});
    ASSERT_EQ(sim.state_hash(), other.state_hash());
  }
  sim.set_node_force(7, Vec3::Zero());
  other.set_node_force(7, -Vec3::Zero());
  sim.step({}), other.step({});
  EXPECT_EQ(sim.state_hash(), other.state_hash());
  other.restore(Simulation(cube()).snapshot());
  EXPECT_EQ(other.state_hash(), at_rest);
  sim.set_node_force(2, {1, 0, 0});
  sim.reset();
  EXPECT_EQ(sim.state_hash(), at_rest);
  EXPECT_EQ(sim.node_forces()[2], Vec3(Vec3::Zero()));
}

TEST(NodeForces, AreInARecording) {
  Simulation sim(cube());
  sim.set_node_force(1, {0, 0, 2e-3});  // before the recording: in its snapshot
  Recording recording(sim);
  for (int step = 0; step < 60; ++step) {
    if (step % 20 == 10) {
      for (const std::uint32_t node : {3u, 3u, 9u}) {  // twice: the later counts
        const Vec3 force(1e-4 * step, 1e-5 * node, 0);
        sim.set_node_force(node, force);
        recording.add_node_force(node, force);
      }
    }
    sim.step({});
    recording.add({}, sim.state_hash());
  }
  const auto path = std::filesystem::temp_directory_path() / "crumble_forces.crec";
  recording.save(path);
  const Recording loaded = Recording::load(path);
  std::filesystem::remove(path);
  Simulation again = loaded.start();
  EXPECT_EQ(replay(loaded, again), std::nullopt);
  EXPECT_EQ(again.state_hash(), sim.state_hash());

  Recording impossible(sim);
  impossible.add_node_force(100000, Vec3::Zero());
  EXPECT_THROW(impossible.apply_changes(0, sim), Error);
}

TEST(NodeForces, RefuseWhatCannotBe) {
  Simulation sim(cube());
  const auto nodes = static_cast<std::uint32_t>(sim.mesh().node_count());
  const auto refused = [&](Code code, const std::string& word, const std::function<void()>& call) {
    const std::uint64_t before = sim.state_hash();
    try {
      call();
      ADD_FAILURE() << word;
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), code);
      EXPECT_NE(std::string(error.what()).find(word), std::string::npos) << error.what();
    }
    EXPECT_EQ(sim.state_hash(), before);
  };
  const double none = std::numeric_limits<double>::quiet_NaN();
  refused(Code::out_of_range, std::to_string(nodes), [&] { sim.set_node_force(nodes, Vec3::Zero()); });
  refused(Code::invalid_value, "node 4", [&] { sim.set_node_force(4, {0, none, 0}); });
  refused(Code::out_of_range, "rows", [&] { sim.set_node_forces(VecArray(nodes - 1)); });
  VecArray forces = equal_forces(sim, {1, 1, 1});
  forces.z[11] = std::numeric_limits<double>::infinity();
  refused(Code::invalid_value, "node 11", [&] { sim.set_node_forces(forces); });
}

// A held node goes nowhere, so nothing diverges: the hand must not get what is not a number.
TEST(NodeForces, TooGreatForASumAreRefused) {
  SimulationDef def = cube();
  def.attachments = {{nodes_below(def.mesh, 1e-6)}};
  Simulation sim(def);
  const Pose hand;
  EXPECT_THROW(sim.set_node_force(def.attachments[0].nodes[0], {1.7e308, 0, 0}), Error);
  EXPECT_THROW(sim.set_node_forces(equal_forces(sim, {0, -1.7e308, 0})), Error);
  for (const double most : {1e12, -1e12}) {
    sim.set_node_forces(equal_forces(sim, {most, most, most}));
    sim.step({&hand, 1});
    EXPECT_TRUE(is_finite(sim.wrench(0).force) && is_finite(sim.wrench(0).torque));
    sim.reset();
  }
}

}  // namespace
}  // namespace crumble
