// Attachments in a whole simulation: nodes that go where a frame goes.
#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

#include "crumble/bubblemesh/presets.hpp"
#include "crumble/sim/simulation.hpp"

namespace crumble {
namespace {

// The cube between two clamps, its bottom and its top.
SimulationDef clamped_cube() {
  static const TetMesh kMesh = generate_paper_body(PaperBody::cube).mesh;
  SimulationDef def;
  def.mesh = kMesh;
  def.gravity = Vec3::Zero();
  def.walls.clear();
  def.attachments = {{nodes_below(def.mesh, 1e-6)}, {nodes_behind(def.mesh, {-Vec3::UnitY(), -0.0299})}};
  return def;
}

Pose lifted(double height) {
  return {Vec3(0, height, 0), Quat::Identity()};
}

TEST(Attachment, StretchesTheBodyAndFeelsWhatItDoes) {
  Simulation sim(clamped_cube());
  std::array<Pose, 2> poses{lifted(0), lifted(0)};
  sim.step(poses);
  const auto [bottom, top] = std::pair{sim.definition().attachments[0].nodes, sim.definition().attachments[1].nodes};
  for (int s = 1; s <= 500; ++s) poses[1] = lifted(1e-6 * s), sim.step(poses);
  for (int s = 0; s < 3000; ++s) sim.step(poses);  // creeps to rest
  for (const std::uint32_t node : top) {
    EXPECT_NEAR(norm(sim.positions()[node] - sim.mesh().positions[node] - Vec3(0, 5e-4, 0)), 0, 1e-15);
  }
  for (const std::uint32_t node : bottom) EXPECT_EQ(sim.positions()[node], sim.mesh().positions[node]);
  // pulled apart: each clamp is drawn to the other, by the same force when the body rests
  const double pull = sim.wrench(0).force.y();
  EXPECT_GT(pull, 0.05);
  EXPECT_NEAR(sim.wrench(1).force.y(), -pull, 0.01 * pull);
  EXPECT_EQ(sim.wrench(0).force.x(), sim.wrench(0).force.x());
}

TEST(Attachment, CarriesALooseBodyAlongAndTurnsIt) {
  SimulationDef def = clamped_cube();
  def.attachments.resize(1);
  Simulation sim(def);
  for (int s = 0; s <= 2000; ++s) {
    const double t = 1e-3 * s, turn = 0.5 * t;
    const Pose pose{Vec3(0.05 * t, 0, 0), axis_angle(Vec3::UnitY(), turn)};
    ASSERT_EQ(sim.step({&pose, 1}).status, Code{});
  }
  EXPECT_EQ(sim.counters().cuts, 0u);
  const Frame frame({Vec3(0.1, 0, 0), axis_angle(Vec3::UnitY(), 1.0)});
  for (std::uint32_t i = 0; i < sim.mesh().node_count(); ++i) {
    EXPECT_LE(norm(sim.positions()[i] - frame.to_scene(sim.mesh().positions[i])), 1e-3);
  }
  EXPECT_LE(sim.ledger().gain_max_relative, 1e-12);
}

TEST(Attachment, NeedsAPoseAndSaysSo) {
  Simulation sim(clamped_cube());
  const std::array<Pose, 1> one{lifted(0)};
  EXPECT_EQ(sim.step(one).status, Code::bad_pose);
  EXPECT_EQ(sim.info().step, 0u);
}

TEST(Attachment, ASnapshotKeepsTheGrip) {
  Simulation sim(clamped_cube()), twin(clamped_cube());
  std::array<Pose, 2> poses{lifted(0), lifted(0)};
  for (int s = 0; s < 100; ++s) poses[1] = lifted(1e-5 * s), sim.step(poses);
  twin.restore(sim.snapshot());
  for (int s = 100; s < 300; ++s) poses[1] = lifted(1e-5 * s), sim.step(poses), twin.step(poses);
  EXPECT_EQ(sim.state_hash(), twin.state_hash());
  EXPECT_NE(norm(sim.wrench(1).force), 0);
}

}  // namespace
}  // namespace crumble
