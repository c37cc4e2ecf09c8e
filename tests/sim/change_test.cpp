// Another definition in mid-run.
#include "crumble/sim/change.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>

#include "crumble/geometry/tool_solids.hpp"
#include "crumble/sim/recording.hpp"
#include "sim/crumbling_rig.hpp"
#include "sim/press_rig.hpp"
#include "support/allocation_counter.hpp"

namespace crumble {
namespace {

template <class Edit>
void change(Simulation& sim, Edit&& edit) {
  SimulationDef next = sim.definition();
  edit(next);
  DefinitionChange(sim.definition(), std::move(next)).apply_to(sim);
}

// Fragments, sleepers, removed ones, fading springs, friction: all of it has to come through.
TEST(DefinitionChange, ToTheSameDefinitionChangesNoBit) {
  for (const Precision precision : {Precision::float64, Precision::float32}) {
    CrumblingRig rig;
    rig.scene.def.step.precision = precision;
    rig.sim = Simulation(rig.scene.def);
    while (rig.sim.fragments().count() < 6) rig.press();
    rig.sim.set_fragment_state(1, FragmentState::asleep);
    rig.sim.set_fragment_state(2, FragmentState::removed);
    rig.sim.set_node_force(7, {0.01, 0, 0});
    while (rig.sim.info().new_cuts == 0) rig.press();  // in the middle of a fade
    ASSERT_GT(rig.sim.ball_contact_count(), 0u);
    CrumblingRig other;
    other.sim = rig.sim;
    other.pose = rig.pose;
    for (int step = 0; step < 300; ++step) {
      if (step % 50 == 0) change(other.sim, [](SimulationDef&) {});
      rig.press(), other.press();
      ASSERT_EQ(other.sim.state_hash(), rig.sim.state_hash()) << "step " << step;
    }
    EXPECT_EQ(other.sim.counters().removed_nodes, rig.sim.counters().removed_nodes);
    EXPECT_EQ(other.sim.counters().asleep, rig.sim.counters().asleep);
    EXPECT_EQ(other.sim.snapshot(), rig.sim.snapshot()) << "and the same definition";
  }
}

// What came before has left its positions and velocities, and nothing else: a simulation that is of the new definition
// from the start goes on from the same state with the same bits.
TEST(DefinitionChange, GoesOnLikeASimulationThatWasMadeSo) {
  PressRig rig;
  rig.press_to(0.004);  // nothing is cut
  ASSERT_EQ(rig.sim.counters().cuts, 0u);
  const auto edit = [](SimulationDef& def) {
    def.material.stiffness = 45;
    def.material.damping_ratio = 20;
    def.material.mass = 0.05;
    def.material.length_limit = 1.15;
    def.gravity = {0.5, -9.81, 0};
    def.step.cut_fade = 0.002;
    def.tools[0].friction = {0.7, 0.4};
  };
  SimulationDef def = rig.sim.definition();
  edit(def);
  const VecView at = rig.sim.positions(), speed = rig.sim.velocities();
  Vector<Vec3> positions, velocities;
  for (std::size_t i = 0; i < at.size(); ++i) positions.push_back(at[i]), velocities.push_back(speed[i]);
  change(rig.sim, edit);
  // the force of the next step answers to the new stiffness at once
  const double before = rig.sim.wrench(0).force.y();
  rig.press();
  EXPECT_NEAR(rig.sim.wrench(0).force.y() / before, 45.0 / 30, 0.15);
  EXPECT_EQ(rig.sim.definition().material.length_limit, 1.15);
  rig.press_to(0.012);
  EXPECT_GT(rig.sim.counters().cuts, 0u);

  // back again, and the body is as stiff as it was
  PressRig same;
  same.press_to(0.004);
  change(same.sim, edit);
  change(same.sim, [&](SimulationDef& back) { back = Simulation(same.scene.def).definition(); });
  PressRig never;
  never.press_to(0.004);
  for (int i = 0; i < 200; ++i) same.press(), never.press();
  EXPECT_EQ(same.sim.state_hash(), never.sim.state_hash());
}

// The stretch of a hanging body is m g / k of its springs: closed, linear, and known to double when k halves.
TEST(DefinitionChange, AHangingBodyStretchesByTheNewStiffness) {
  Scene scene = load_scene("tofu_cube", Preset::standard);
  scene.def.walls.clear();
  scene.def.gravity = {0, -9.81, 0};
  scene.def.fixed_nodes = nodes_behind(scene.def.mesh, {-Vec3::UnitY(), -0.0299});  // by its top
  scene.def.material.length_limit = 3;
  scene.def.material.damping_ratio = 3;
  Simulation sim(scene.def);
  const Pose away{{0, 1, 0}, Quat::Identity()};
  const auto lowest = [&] {
    for (int step = 0; step < 4000; ++step) sim.step({&away, 1});
    const VecView p = sim.positions();
    return *std::min_element(p.y.begin(), p.y.end());
  };
  const double at_30 = -lowest();
  change(sim, [](SimulationDef& def) { def.material.stiffness = 60; });
  const double at_60 = -lowest();
  EXPECT_GT(at_30, 1e-5);
  EXPECT_NEAR(at_60 / at_30, 0.5, 0.02);
  change(sim, [](SimulationDef& def) { def.gravity = Vec3::Zero(); });
  EXPECT_NEAR(lowest(), 0, 1e-6);
}

TEST(DefinitionChange, TakesNoMemoryWhereItIsMade) {
  if (!AllocationCounter::available()) GTEST_SKIP() << "nothing is counted here";
  CrumblingRig rig;
  while (rig.sim.fragments().count() < 4) rig.press();
  SimulationDef next = rig.sim.definition();
  next.material.stiffness = 20;
  next.tools[0].friction = {2, 1};
  next.walls.push_back({{Vec3::UnitY(), -0.001}, {1, 0.5}});
  next.fixed_nodes = nodes_below(next.mesh, 0.003);
  DefinitionChange all(rig.sim.definition(), next);
  next.step.ball_contact = false;
  next.step.surface_samples = false;
  next.tools[0].shape = make_capsule(0.003, 0.04);
  DefinitionChange more(all.definition(), next);
  const AllocationCounter counter;
  all.apply_to(rig.sim);
  rig.press();
  more.apply_to(rig.sim);
  rig.press();
  EXPECT_EQ(counter.count(), 0u);
}

TEST(DefinitionChange, NodesThatBecomeFixedStopAndThoseSetFreeMove) {
  PressRig rig;
  rig.press_to(0.005);
  const std::uint32_t node = rig.sim.contacts().front().node;
  change(rig.sim, [&](SimulationDef& def) { def.fixed_nodes.push_back(node); });
  const Vec3 there = rig.sim.positions()[node];
  for (int i = 0; i < 100; ++i) rig.press();
  EXPECT_EQ(rig.sim.positions()[node], there);
  for (const NodeConstraint& c : rig.sim.contacts()) EXPECT_NE(c.node, node);
  change(rig.sim, [&](SimulationDef& def) { def.fixed_nodes.clear(); });
  for (int i = 0; i < 100; ++i) rig.press();
  EXPECT_GT(norm(rig.sim.positions()[node] - there), 1e-5);
}

TEST(DefinitionChange, AToolOfAnotherShapeLetsGoUntilItHasBeenOutside) {
  PressRig rig;
  rig.press_to(0.005);
  ASSERT_GT(rig.sim.wrench(0).force.y(), 0.1);
  change(rig.sim, [](SimulationDef& def) { def.tools[0].shape = make_capsule(0.006, 0.05); });
  const double deepest = static_cast<double>(rig.sim.info().step) * 1e-5;
  Pose pose = rig.pose_at(rig.sim.info().step);
  rig.sim.step({&pose, 1});
  EXPECT_FALSE(rig.sim.engaged(0));
  EXPECT_EQ(rig.sim.wrench(0).force, Vec3(Vec3::Zero())) << "no kick";
  for (double y = 0; y < deepest + 0.01; y += 5e-5) {  // out ...
    pose.position.y() += 5e-5;
    rig.sim.step({&pose, 1});
  }
  EXPECT_TRUE(rig.sim.engaged(0));
  for (double y = 0; y < 0.012; y += 2e-5) {  // ... and in again
    pose.position.y() -= 2e-5;
    rig.sim.step({&pose, 1});
  }
  EXPECT_GT(rig.sim.wrench(0).force.y(), 0.1);
}

TEST(DefinitionChange, FrictionOfAToolThatHoldsChangesAtOnce) {
  const auto drag = [](Friction friction) {
    PressRig rig;
    rig.press_to(0.005);
    change(rig.sim, [&](SimulationDef& def) { def.tools[0].friction = friction; });
    for (const NodeConstraint& c : rig.sim.contacts()) {  // what a local model goes by, before any step
      EXPECT_EQ(c.static_friction, c.holder == 0 ? friction.static_coefficient : c.static_friction);
    }
    Pose pose = rig.pose_at(rig.sim.info().step);
    double most = 0;
    for (int i = 0; i < 100; ++i) {
      pose.position.x() += 2e-5;
      rig.sim.step({&pose, 1});
      most = std::max(most, std::abs(rig.sim.wrench(0).force.x()) / rig.sim.wrench(0).force.y());
    }
    return most;
  };
  // the stick lies in a hollow, whose side it pushes without friction too
  const double smooth = drag({0, 0}), rough = drag({3, 1.5});
  EXPECT_GT(rough, 1.5 * smooth) << smooth;
}

TEST(DefinitionChange, EnergyBooksStayBalanced) {
  PressRig rig("tofu_cube", Preset::standard, 0.01, true);
  rig.press_to(0.006);
  change(rig.sim, [](SimulationDef& def) { def.material.stiffness = 50, def.step.energy_audit = true; });
  rig.press_to(0.012);
  const EnergyLedger& books = rig.sim.ledger();
  const double sum = books.tool_work + books.external_work - books.dissipated - books.cut;
  EXPECT_NEAR(sum, books.stored, 1e-9 * std::abs(books.tool_work));
  EXPECT_LT(books.gain_max_relative, 1e-12);
}

TEST(DefinitionChange, IsInARecording) {
  PressRig rig("tofu_cube", Preset::standard, 0.02);
  rig.press_to(0.004);
  Recording recording(rig.sim);
  const auto record = [&](double depth) {
    while (rig.speed * rig.sim.info().time < depth) {
      const Pose pose = rig.pose_at(rig.sim.info().step);
      rig.press();
      recording.add({&pose, 1}, rig.sim.state_hash());
    }
  };
  record(0.006);
  change(rig.sim, [](SimulationDef& def) { def.material.stiffness = 20, def.material.length_limit = 1.1; });
  recording.add_change(Recording::settings_of(rig.sim.definition()));
  record(0.01);
  const auto path = std::filesystem::temp_directory_path() / "crumble_change_test.crec";
  recording.save(path);
  const Recording loaded = Recording::load(path);
  std::filesystem::remove(path);
  Simulation again = loaded.start();
  EXPECT_EQ(again.definition().material.stiffness, 30);
  EXPECT_EQ(replay(loaded, again), std::nullopt);
  EXPECT_EQ(again.definition().material.stiffness, 20);
  EXPECT_EQ(again.state_hash(), rig.sim.state_hash());
}

TEST(DefinitionChange, WhatCannotChangeIsSaid) {
  PressRig rig;
  const auto refusal = [&](auto&& edit) -> std::string {
    SimulationDef next = rig.sim.definition();
    edit(next);
    try {
      DefinitionChange(rig.sim.definition(), std::move(next));
    } catch (const Error& error) {
      return (error.code() == Code::state ? "state: " : "other: ") + std::string(error.what());
    }
    return "none";
  };
  EXPECT_EQ(refusal([](SimulationDef&) {}), "none");
  EXPECT_EQ(refusal([](SimulationDef& d) { d.step.tau = 2e-3; }).find("state: tau is 0.001 and cannot become 0.002"),
            0u);
  EXPECT_EQ(refusal([](SimulationDef& d) { d.step.precision = Precision::float32; }).find("state: precision"), 0u);
  EXPECT_EQ(refusal([](SimulationDef& d) { d.tools.push_back(d.tools[0]); }).find("state: the number of tools"), 0u);
  EXPECT_EQ(refusal([](SimulationDef& d) { d.attachments.push_back({{0}}); }).find("state: attachments"), 0u);
  EXPECT_EQ(refusal([](SimulationDef& d) { d.mesh.positions[0].x() += 1e-5; }).find("state: the mesh"), 0u);
  EXPECT_EQ(refusal([](SimulationDef& d) { d.material.stiffness = -1; }).find("other: "), 0u);
}

}  // namespace
}  // namespace crumble
