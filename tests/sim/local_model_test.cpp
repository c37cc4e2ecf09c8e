#include "crumble/sim/local_model.hpp"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <cmath>
#include <limits>
#include <set>
#include <tuple>

#include "crumble/base/memory.hpp"
#include "crumble/tetmesh/lattice_box.hpp"
#include "sim/press_rig.hpp"
#include "support/allocation_counter.hpp"

namespace crumble {
namespace {

using Mat6 = Eigen::Matrix<double, 6, 6>;
using Vec6 = Eigen::Matrix<double, 6, 1>;

Mat6 matrix_of(const WrenchJacobian& j) {
  return Eigen::Map<const Eigen::Matrix<double, 6, 6, Eigen::RowMajor>>(j.data());
}
Vec6 vector_of(const Wrench& w) {
  Vec6 v;
  v << w.force, w.torque;
  return v;
}
Pose moved(const Pose& at, const Vec3& shift, const Vec3& turn) {
  const double angle = turn.norm();
  const Quat q = angle > 0 ? axis_angle(turn / angle, angle) : Quat::Identity();
  return {at.position + shift, multiply(q, at.orientation)};
}

/// The cube under its stick, with friction of our choice and cut springs gone at once: then `intact` says it all.
struct ModelRig : PressRig {
  explicit ModelRig(double friction, const std::string& name = "tofu_cube") : PressRig(name) {
    scene.def.tools[0].friction = {friction, friction};
    scene.def.step.cut_fade = 0;
    scene.def.step.ball_contact = false;
    sim = Simulation(scene.def);
  }
  LocalModel model() const { return sim.local_model(0); }
  std::set<std::uint32_t> held() const {
    std::set<std::uint32_t> nodes;
    for (const NodeConstraint& c : sim.contacts()) {
      if (c.holder == 0) nodes.insert(c.node);
    }
    return nodes;
  }
  /// Eq (5) for one spring: the force on its end at `a`.
  Vec3 pull(std::size_t spring, const Vec3& a, const Vec3& b) const {
    if (!sim.intact()[spring]) return Vec3::Zero();
    const Vec3 way = b - a;
    return sim.network().stiffnesses[spring] * (way.norm() - sim.network().rest_lengths[spring]) * way.normalized();
  }
  /// - d pull / d a by central differences, without what is negative in it.
  Mat3 tangent(std::size_t spring, const Vec3& a, const Vec3& b) const {
    constexpr double kStep = 1e-8;
    Mat3 k;
    for (int axis = 0; axis < 3; ++axis) {
      const Vec3 step = kStep * Vec3::Unit(axis);
      k.col(axis) = (pull(spring, a - step, b) - pull(spring, a + step, b)) / (2 * kStep);
    }
    const Eigen::SelfAdjointEigenSolver<Mat3> solver(0.5 * (k + k.transpose()));
    return solver.eigenvectors() * solver.eigenvalues().cwiseMax(0).asDiagonal() * solver.eigenvectors().transpose();
  }
  /// Where a held node goes per motion of the tool: with it, or along its normal.
  Mat3 way_of(std::uint32_t node) const {
    for (const NodeConstraint& c : sim.contacts()) {
      if (c.node == node && (c.state == ContactState::slip || c.static_friction == 0)) {
        return c.normal * c.normal.transpose();
      }
    }
    return Mat3::Identity();
  }
  /// The sum of - G^T K G over the contacts, from the tangents above; sliding contacts by their normals.
  Mat6 jacobian() const {
    const std::set<std::uint32_t> mine = held();
    Mat6 sum = Mat6::Zero();
    for (const NodeConstraint& c : sim.contacts()) {
      if (c.holder != 0) continue;
      const Vec3 here = sim.positions()[c.node];
      Mat3 k = Mat3::Zero();
      Vec3 force = sim.network().masses[c.node] * scene.def.gravity;
      for (std::size_t s = 0; s < sim.network().spring_count(); ++s) {
        const auto [a, b] = sim.network().springs[s];
        if (a != c.node && b != c.node) continue;
        const std::uint32_t other = a == c.node ? b : a;
        const Mat3 stiff = tangent(s, here, sim.positions()[other]);
        if (!mine.contains(other)) {
          k += stiff;
        } else if (const Mat3 mine_moves = way_of(c.node), moves = way_of(other); moves != Mat3::Identity()) {
          const Mat3 apart = mine_moves - moves;
          const bool both_slide = mine_moves != Mat3::Identity();
          k += both_slide ? Mat3(c.normal * (apart * c.normal).dot(stiff * apart * c.normal) * c.normal.transpose())
                          : Mat3(apart * stiff * apart);
        }
        force += pull(s, here, sim.positions()[other]);
      }
      const double pressing = -force.dot(c.normal);
      if (pressing <= 0) continue;  // the next step lets it go
      const double grip = c.state == ContactState::slip ? c.dynamic_friction : c.static_friction;
      if ((force + pressing * c.normal).norm() > grip * pressing)
        k = c.normal * c.normal.dot(k * c.normal) * c.normal.transpose();
      const Vec3 arm = here - model().at.position;
      Eigen::Matrix<double, 3, 6> g;
      g << Mat3::Identity(), Vec3::UnitX().cross(arm), Vec3::UnitY().cross(arm), Vec3::UnitZ().cross(arm);
      sum -= g.transpose() * k * g;
    }
    return sum;
  }
};

TEST(LocalModel, JacobianIsTheTangentOfTheForceLawWithNeighborsHeld) {
  for (const double friction : {0.0, 0.3, 3.0}) {
    for (const double depth : {0.003, 0.012}) {  // before and after the first cuts
      ModelRig rig(friction);
      rig.press_to(depth);
      const LocalModel model = rig.model();
      ASSERT_GT(model.contacts, 8u);
      EXPECT_LE(model.contacts, rig.held().size());
      const Mat6 expected = rig.jacobian(), got = matrix_of(model.jacobian);
      EXPECT_LE((got - expected).norm(), 1e-5 * expected.norm()) << friction << " at " << depth;
      const Mat3 turning = got.bottomRightCorner(3, 3), due = expected.bottomRightCorner(3, 3);
      EXPECT_LE((turning - due).norm(), 1e-5 * due.norm());
    }
  }
}

TEST(LocalModel, JacobianIsSymmetricAndNeverPositive) {
  for (const double friction : {0.0, 3.0}) {
    ModelRig rig(friction);
    while (rig.speed * rig.sim.info().time < 0.02) {
      rig.press();
      if (rig.sim.info().step % 50 != 0) continue;
      const LocalModel model = rig.model();
      const Mat6 j = matrix_of(model.jacobian);
      ASSERT_LE((j - j.transpose()).norm(), 1e-12 * (1 + j.norm()));
      const Vec6 eigenvalues = Eigen::SelfAdjointEigenSolver<Mat6>(j).eigenvalues();
      ASSERT_LE(eigenvalues.maxCoeff(), 1e-12 * (1 + j.norm()));
      ASSERT_LE((model.stiffness + j.topLeftCorner(3, 3)).norm(), 1e-12 * (1 + j.norm()));
    }
  }
}

// The springs' true tangent, compressed ones giving way sideways, is never stiffer than the model.
TEST(LocalModel, TheForceLawIsNeverStifferThanTheModel) {
  ModelRig rig(3);
  rig.press_to(0.006);
  const LocalModel model = rig.model();
  const std::set<std::uint32_t> mine = rig.held();
  const auto force = [&](const Vec3& shift) {
    Vec3 sum = Vec3::Zero();
    for (std::size_t s = 0; s < rig.sim.network().spring_count(); ++s) {
      const auto [a, b] = rig.sim.network().springs[s];
      if (mine.contains(a) == mine.contains(b)) continue;
      const Vec3 x = rig.sim.positions()[a], y = rig.sim.positions()[b];
      sum += mine.contains(a) ? rig.pull(s, x + shift, y) : rig.pull(s, y + shift, x);
    }
    return sum;
  };
  for (const Vec3& axis : {Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(0, 0, 1), Vec3(0.6, 0.8, 0), Vec3(0, -0.6, 0.8)}) {
    const double truth = -(force(1e-7 * axis) - force(-1e-7 * axis)).dot(axis) / 2e-7;
    const double kept = axis.dot(model.stiffness * axis);
    EXPECT_LE(truth, kept * (1 + 1e-6));
    EXPECT_GT(truth, 0.2 * kept);
  }
}

/// The contacts of the tool: the same before and after a step when nothing was let go or met, has begun or ceased to
/// slide or has slid onto another face.
Vector<std::tuple<std::uint32_t, ContactState, double, double>> contacts_of(const Simulation& sim) {
  Vector<std::tuple<std::uint32_t, ContactState, double, double>> all;
  for (const NodeConstraint& c : sim.contacts()) {
    if (c.holder == 0)
      all.emplace_back(c.node, c.state, std::round(1e3 * c.normal.x()), std::round(1e3 * c.normal.y()));
  }
  return all;
}

// What it promises of a tool that stays, and of one that moves by 1 um: copies of the simulation do so.
TEST(LocalModel, ForetellsTheNextStepOfTheSimulation) {
  for (const double friction : {0.0, 3.0}) {
    PressRig rig;
    rig.scene.def.tools[0].friction = {friction, friction};
    rig.scene.def.step.ball_contact = false;  // the model has their last push only
    rig.sim = Simulation(rig.scene.def);
    double still = 0, linear = 0, evaluated = 0, torque = 0;
    int compared = 0;
    while (rig.speed * rig.sim.info().time < 0.02) {
      rig.press();
      if (rig.sim.info().step % 20 != 0) continue;
      const LocalModel model = rig.sim.local_model(0);
      for (const Vec3& direction : {Vec3(0, 0, 0), Vec3(0, -1, 0), Vec3(0.6, -0.8, 0), Vec3(0, -0.6, 0.8)}) {
        Simulation next = rig.sim;
        const Vec3 shift = 1e-6 * direction, turn = 1e-4 * Vec3(direction.z(), 0, direction.x());
        const Pose pose = moved(model.at, shift, turn);
        next.step({&pose, 1});
        if (model.contacts == 0 || contacts_of(next) != contacts_of(rig.sim) || next.info().new_cuts > 0) continue;
        ++compared;
        Vec6 motion;
        motion << shift, turn;
        const double size = norm(next.wrench(0).force), arm = 0.01;
        const Vec6 sum = vector_of(model.wrench) + matrix_of(model.jacobian) * motion;
        const Wrench there = evaluate(model, pose);
        const double error = norm(there.force - next.wrench(0).force) / size;
        (direction.norm() == 0 ? still : evaluated) = std::max(direction.norm() == 0 ? still : evaluated, error);
        linear = std::max(linear, norm(Vec3(sum.head(3)) - next.wrench(0).force) / size);
        torque = std::max(torque, norm(there.torque - next.wrench(0).torque) / (arm * size));
      }
    }
    EXPECT_GT(compared, friction > 0 ? 50 : 100);
    std::printf("friction %g, %d comparisons: still %.2g, 1 um: F0 + J dx %.2g, evaluate %.2g, torque %.2g\n", friction,
                compared, still, linear, evaluated, torque);
    EXPECT_LE(still, 1e-9);
    EXPECT_LE(linear, 5e-3);
    EXPECT_LE(evaluated, 5e-3);
    EXPECT_LE(torque, 5e-3);
  }
}

// Without friction all nodes slide, each along its own normal, and the springs between them count too.
TEST(LocalModel, SlidingContactsAreNoSofterThanTheNextStep) {
  ModelRig rig(0);
  int compared = 0;
  while (rig.speed * rig.sim.info().time < 0.02) {
    rig.press();
    if (rig.sim.info().step % 50 != 0) continue;
    const LocalModel model = rig.model();
    Simulation next = rig.sim;
    const Pose pose = moved(model.at, {0, -1e-6, 0}, Vec3::Zero());
    next.step({&pose, 1});
    if (model.contacts == 0 || contacts_of(next) != contacts_of(rig.sim) || next.info().new_cuts > 0) continue;
    const double change = next.wrench(0).force.y() - model.wrench.force.y();
    EXPECT_GE(evaluate(model, pose).force.y() - model.wrench.force.y(), 0.99 * change);
    compared += change > 0;
  }
  EXPECT_GT(compared, 20);
}

// Up and away: the contacts let go one after the other, no pull and no jump, where the plain sum would pull.
TEST(LocalModel, ContactsThatWouldPullLetGoOneByOne) {
  for (const double friction : {0.0, 0.3}) {
    ModelRig rig(friction);
    rig.press_to(0.003);  // less than the radius: no flank of the stick holds it back
    const LocalModel model = rig.model();
    ASSERT_GT(model.listed, 8u);
    const double slack = 1e-12;
    double last = model.wrench.force.y();
    int letting_go = 0;
    double still_pressing = 0;
    for (int k = 0; k <= 4000; ++k) {
      const Wrench there = evaluate(model, moved(model.at, {0, 1e-6 * k, 0}, Vec3::Zero()));
      ASSERT_GE(there.force.y(), -slack) << k;
      ASSERT_LE(there.force.y(), last + slack) << k;
      ASSERT_LE(last - there.force.y(), 0.05 * model.wrench.force.y()) << k;
      letting_go += there.force.y() < last;
      if (there.force.y() > 0) still_pressing = 1e-6 * k;
      last = there.force.y();
    }
    EXPECT_EQ(last, 0) << friction;
    EXPECT_GT(letting_go, 100);
    // the plain sum has begun to pull long before the last contact lets go
    EXPECT_GT(still_pressing * model.stiffness(1, 1), 1.05 * model.wrench.force.y());
  }
}

// Within the radius the linear sum is all: no contact lets go there, whichever way the nodes go.
TEST(LocalModel, NothingChangesWithinTheRadius) {
  for (const double friction : {0.0, 1e6}) {
    ModelRig rig(friction);
    int tight = 0;
    while (rig.speed * rig.sim.info().time < 0.015) {
      rig.press();
      if (rig.sim.info().step % 100 != 0) continue;
      const LocalModel model = rig.model();
      EXPECT_LE(model.radius, LocalModel::kReach);
      tight += model.radius < LocalModel::kReach;
      for (const Vec3& axis : {Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(0, 0, 1), Vec3(0, -1, 0), Vec3(-0.6, 0.8, 0)}) {
        const Vec3 shift = 0.999 * model.radius * axis;
        const Vec3 sum = model.wrench.force - model.stiffness * shift;
        EXPECT_LE((evaluate(model, moved(model.at, shift, Vec3::Zero())).force - sum).norm(), 1e-12);
      }
    }
    EXPECT_GT(tight, 3);
  }
}

// A plate on a finer body holds more nodes than the list does.
TEST(LocalModel, WhatTheListHasNoRoomForIsInTheSum) {
  PressRig rig;
  rig.scene.def.mesh = make_lattice_box({0.03, 0.03, 0.03}, 0.0025);
  rig.scene.def.fixed_nodes = nodes_below(rig.scene.def.mesh, 1e-6);
  rig.scene.def.tools[0].shape = make_bar({0.06, 0.012, 0.06});
  rig.scene.def.tools[0].friction = {0.5, 0.4};
  rig.sim = Simulation(rig.scene.def);
  for (int step = 0; step < 200; ++step) {
    const Pose pose{{0, 0.036 - 1e-5 * step, 0}, Quat::Identity()};
    rig.sim.step({&pose, 1});
  }
  const LocalModel model = rig.sim.local_model(0);
  ASSERT_EQ(model.listed, LocalModel::kListed);
  ASSERT_GT(model.contacts, model.listed);
  const Wrench here = evaluate(model, model.at);
  EXPECT_LE((vector_of(here) - vector_of(model.wrench)).norm(), 1e-12 * vector_of(model.wrench).norm());
  const Vec3 shift = {0, -1e-5, 0};
  const Vec3 deeper = evaluate(model, moved(model.at, shift, Vec3::Zero())).force;
  EXPECT_LE((deeper - (model.wrench.force - model.stiffness * shift)).norm(), 5e-3 * deeper.norm());
  double last = model.wrench.force.y();
  for (int k = 0; k <= 3000; ++k) {
    const Wrench there = evaluate(model, moved(model.at, {0, 1e-6 * k, 0}, Vec3::Zero()));
    ASSERT_GE(there.force.y(), -1e-12);
    ASSERT_LE(there.force.y(), last + 1e-12);
    last = there.force.y();
  }
  EXPECT_EQ(last, 0);
}

TEST(LocalModel, TurningTurnsTheArmsToo) {
  ModelRig rig(1e6);
  rig.press_to(0.01);
  const LocalModel model = rig.model();
  // d torque / d rotation by differences of evaluate() is the Jacobian and the turn of the arms under today's forces
  Mat3 turning = Mat3::Zero();
  for (std::uint32_t k = 0; k < model.listed; ++k) {
    const LocalContact& c = model.contact[k];
    for (int axis = 0; axis < 3; ++axis) {
      const Vec3 turn = Vec3::Unit(axis);
      turning.col(axis) += turn.cross(c.arm).cross(c.force) + turn.cross(c.arm.cross(c.inner));
    }
  }
  Mat3 differences;
  for (int axis = 0; axis < 3; ++axis) {
    const Vec3 turn = 1e-7 * Vec3::Unit(axis);
    differences.col(axis) = (evaluate(model, moved(model.at, Vec3::Zero(), turn)).torque -
                             evaluate(model, moved(model.at, Vec3::Zero(), -turn)).torque) /
                            2e-7;
  }
  const Mat3 expected = Mat3(matrix_of(model.jacobian).bottomRightCorner(3, 3)) + turning;
  EXPECT_LE((differences - expected).norm(), 1e-6 * expected.norm());
  EXPECT_GT(turning.norm(), 1e-3 * expected.norm());
}

TEST(LocalModel, IsEmptyWithoutContact) {
  ModelRig rig(3);
  const Pose above = moved(rig.pose_at(0), {0, 0.001, 0}, Vec3::Zero());
  rig.sim.step({&above, 1});
  for (const LocalModel& model : {rig.model(), LocalModel{}}) {
    EXPECT_EQ(model.contacts, 0u);
    EXPECT_EQ(vector_of(model.wrench).norm(), 0);
    EXPECT_EQ(matrix_of(model.jacobian).norm(), 0);
    EXPECT_EQ(vector_of(evaluate(model, rig.pose_at(900))).norm(), 0);
    EXPECT_EQ(model.held_drag, 0);
    EXPECT_EQ(model.radius, LocalModel::kReach);
  }
  rig.press_to(0.01);
  const LocalModel model = rig.model();
  EXPECT_GT(norm(model.wrench.force), 0);
  EXPECT_EQ(model.at.position, rig.pose_at(rig.sim.info().step - 1).position);
  Pose bad = model.at;
  bad.position.x() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(vector_of(evaluate(model, bad)).norm(), 0);
  rig.sim.step({&bad, 1});
  EXPECT_EQ(vector_of(rig.model().wrench).norm(), 0);  // refused: no force
}

// Eq (2): c = 2 alpha sqrt(m k) of the stiffest spring at the node, all 30 N/m here.
TEST(LocalModel, HeldDragIsThatOfTheHeldNodes) {
  ModelRig rig(3);
  rig.press_to(0.01);
  double sum = 0;
  for (const std::uint32_t node : rig.held()) sum += rig.sim.network().drags[node];
  ASSERT_EQ(rig.sim.coefficients().guarded_nodes, 0u);
  EXPECT_NEAR(rig.sim.held_drag(0), sum, 1e-12 * sum);
  EXPECT_EQ(rig.model().held_drag, rig.sim.held_drag(0));
  EXPECT_GT(sum, 10);
}

TEST(LocalModel, TellsOfCuts) {
  ModelRig rig(3);
  int cuts = 0;
  while (rig.speed * rig.sim.info().time < 0.015) {
    cuts += rig.press().new_cuts > 0;
    ASSERT_EQ(rig.model().fracture, rig.sim.info().new_cuts > 0);
  }
  EXPECT_GT(cuts, 5);
}

TEST(LocalModel, ChangesNothingAndAllocatesNothing) {
  if (!AllocationCounter::available()) GTEST_SKIP() << "a sanitizer owns malloc";
  ModelRig asked(0.5), alone(0.5);
  asked.press_to(0.004), alone.press_to(0.004);
  double sum = 0;
  {
    const AllocationCounter counter;
    while (asked.speed * asked.sim.info().time < 0.015) {
      asked.press();
      const LocalModel model = asked.model();
      sum += evaluate(model, asked.pose_at(asked.sim.info().step)).force.y();
    }
    EXPECT_EQ(counter.count(), 0u);
  }
  alone.press_to(0.015);
  EXPECT_GT(sum, 0);
  EXPECT_EQ(asked.sim.state_hash(), alone.sim.state_hash());
}

TEST(LocalModel, IsTheSameFromASnapshot) {
  ModelRig rig(0.5);
  rig.press_to(0.002);
  const Simulation live = rig.sim;
  rig.sim.restore(rig.sim.snapshot());
  const LocalModel before = live.local_model(0), after = rig.model();
  EXPECT_GT(before.contacts, 2u);
  EXPECT_EQ(after.wrench.force, before.wrench.force);
  EXPECT_EQ(after.jacobian, before.jacobian);
  const Pose aside = moved(before.at, {2e-4, 0, 0}, Vec3::Zero());
  EXPECT_EQ(evaluate(after, aside).force, evaluate(before, aside).force);
}

}  // namespace
}  // namespace crumble
