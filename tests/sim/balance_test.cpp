// Newton's third law, and the law of the lever: what the tools feel is what the body is pushed by.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>

#include "crumble/tetmesh/lattice_box.hpp"
#include "sim/press_rig.hpp"

namespace crumble {
namespace {

struct Sum {
  Vec3 force = Vec3::Zero(), torque = Vec3::Zero();  // the torque about the scene's origin
  double size = 0;                                   // of all forces added up
  void add(const Vec3& at, const Vec3& f) {
    force += f;
    torque += cross(at, f);
    size += norm(f);
  }
};

// Two sticks press the cube between them and turn, and it breaks; the floor is a wall.
TEST(Balance, SpringsReactionsToolsAndSupportAddUpToNothing) {
  PressRig rig;
  SimulationDef& def = rig.scene.def;
  def.fixed_nodes.clear();
  def.gravity = {0, -9.81, 0};
  def.walls = {{{Vec3::UnitY(), 0}, {0.4, 0.3}}};
  def.tools[0].friction = {0.5, 0.4};
  def.tools.push_back(def.tools[0]);
  rig.sim = Simulation(def);
  const double tau = def.step.tau;
  int tested = 0, on_floor = 0;
  for (int step = 0; step < 900; ++step) {
    const double way = 0.02 * step * tau;
    const std::array<Pose, 2> poses{Pose{{-0.0191 + way, 0.017, 0}, axis_angle(Vec3::UnitX(), 0.3 + 0.2 * step * tau)},
                                    Pose{{0.0191 - way, 0.012, 0}, axis_angle(Vec3::UnitX(), 0.1 * step * tau)}};
    rig.sim.step(poses);
    // the reactions answer the forces at the start of the solve; the springs are in balance at any time
    const VecArray forces = rig.sim.forces();
    Sum springs, held, tools, support;
    for (std::size_t i = 0; i < forces.size(); ++i) {
      springs.add(rig.sim.positions()[i], forces[i] - rig.sim.network().masses[i] * def.gravity);
    }
    for (const NodeConstraint& c : rig.sim.contacts())
      (c.holder == kWorldHolder ? support : held).add(c.point, c.reaction);
    for (std::size_t tool = 0; tool < 2; ++tool) {
      const Wrench& w = rig.sim.wrench(tool);
      tools.add(poses[tool].position, w.force);
      tools.torque += w.torque;
    }
    springs.size += 1e-3;  // N: before the tools press there is next to nothing
    ASSERT_LE(norm(springs.force), 1e-10 * springs.size);
    ASSERT_LE(norm(springs.torque), 1e-10 * springs.size);
    ASSERT_LE(norm(held.force + tools.force), 1e-10 * springs.size);
    ASSERT_LE(norm(held.torque + tools.torque), 1e-10 * springs.size);
    tested += tools.size > 0.1;
    on_floor += support.size > 0;
  }
  EXPECT_GT(tested, 200);
  EXPECT_GT(on_floor, 500);
  EXPECT_GT(rig.sim.counters().cuts, 10u);
}

// Pressed slowly, drag and inertia are next to nothing: what goes in at the tools comes out at the support.
TEST(Balance, TheSupportCarriesWhatTheToolsPress) {
  PressRig rig;
  rig.speed = 1e-4;
  rig.scene.def.step.tau = 5e-3;
  rig.scene.def.gravity = Vec3::Zero();
  rig.sim = Simulation(rig.scene.def);
  rig.press_to(0.0015);
  for (int step = 0; step < 8000; ++step) {  // until it has relaxed, 40 s
    const Pose pose = rig.pose_at(3000);
    rig.sim.step({&pose, 1});
  }
  const VecArray forces = rig.sim.forces();
  Sum support;
  for (const std::uint32_t node : rig.scene.def.fixed_nodes) support.add(rig.sim.positions()[node], -forces[node]);
  const Wrench& w = rig.sim.wrench(0);
  ASSERT_GT(norm(w.force), 0.05);
  EXPECT_LE(norm(w.force - support.force), 0.01 * norm(w.force));
  // and its torque too, about the same point
  const Vec3 at_origin = w.torque + cross(rig.pose_at(3000).position, w.force);
  EXPECT_LE(norm(at_origin - support.torque), 0.01 * 0.03 * norm(w.force));
}

SimulationDef fixed_cube() {
  SimulationDef def;
  def.mesh = make_lattice_box({0.03, 0.03, 0.03}, 0.005);
  def.fixed_nodes = nodes_below(def.mesh, 1e-6);
  return def;
}

// A pin 1 mm thick goes down on one node of the top. The hand holds it 2 cm beside its tip and turned, so the lever
// is known beforehand.
TEST(Balance, OffCenterPushGivesTheTorqueOfTheLever) {
  for (const double friction : {1.0, 3.0}) {  // without any it would slide off the node
    SimulationDef def = fixed_cube();
    def.step.surface_samples = false;
    const Vec3 lever = {0.02, -0.01, 0.005};  // from the hand to the tip, in the hand's frame
    Tool pin{make_bar({0.001, 0.02, 0.001}), {friction, friction}, {}};
    pin.offset.position = lever + Vec3(0, 0.01, 0);  // the middle of the pin
    def.tools.push_back(pin);
    Vec3 top = Vec3::Zero();
    for (const Vec3& node : def.mesh.positions) {
      if (norm(node - Vec3(0.004, 0.03, 0.003)) < norm(top - Vec3(0.004, 0.03, 0.003))) top = node;
    }
    ASSERT_NEAR(top.y(), 0.03, 1e-9);
    Simulation sim(def);
    const Quat turned = axis_angle(Vec3::UnitY(), 0.5);
    const Vec3 arm = rotate(rotation_matrix(turned), lever);
    for (int step = 0; step < 200; ++step) {
      const Pose hand{top - arm + Vec3(0, 1e-4 - 1e-5 * step, 0), turned};
      sim.step({&hand, 1});
    }
    const Wrench& w = sim.wrench(0);
    ASSERT_EQ(sim.info().contacts, 1u);
    ASSERT_GT(w.force.y(), 0.01);
    EXPECT_LE(norm(w.torque - cross(arm, w.force)), 0.01 * norm(cross(arm, w.force)));
    EXPECT_GT(norm(w.torque), 0.015 * norm(w.force));
  }
}

// Two bars press a free cube between them, each held well off its middle. At rest two wrenches alone balance: about
// any point their torques cancel, so what the one feels about its own origin is the other's and the lever between them.
TEST(Balance, EachOfTwoToolsFeelsItsOwnLever) {
  SimulationDef def = fixed_cube();
  def.fixed_nodes.clear();
  def.walls.clear();
  def.gravity = Vec3::Zero();
  for (int tool = 0; tool < 2; ++tool) def.tools.push_back({make_bar({0.008, 0.01, 0.1}), {1, 1}, {}});
  Simulation sim(def);
  const std::array<Vec3, 2> origins{Vec3(-0.0175, 0.018, 0.03), Vec3(0.0175, 0.013, -0.025)};
  for (int step = 0; step < 20000; ++step) {
    const Vec3 in = {std::min(1e-6 * step, 1.5e-3), 0, 0};
    const std::array<Pose, 2> poses{Pose{origins[0] - Vec3(0.0016, 0, 0) + in, Quat::Identity()},
                                    Pose{origins[1] + Vec3(0.0016, 0, 0) - in, Quat::Identity()}};
    sim.step(poses);
  }
  const Wrench &left = sim.wrench(0), &right = sim.wrench(1);
  const Vec3 lever = sim.local_model(0).at.position - sim.local_model(1).at.position;
  ASSERT_LT(left.force.x(), -0.05);
  EXPECT_LE(norm(left.force + right.force), 0.01 * norm(left.force));
  EXPECT_GT(norm(left.torque), 0.02 * norm(left.force));
  const Vec3 due = -right.torque - cross(lever, left.force);
  EXPECT_LE(norm(left.torque - due), 0.01 * norm(left.torque));
}

}  // namespace
}  // namespace crumble
