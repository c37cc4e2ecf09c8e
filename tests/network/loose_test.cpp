// Loose bodies: drag in the frame of the fragment, and dampers along springs.
#include <gtest/gtest.h>

#include <cmath>

#include "crumble/base/memory.hpp"
#include "crumble/geometry/pose.hpp"
#include "network/loose_body.hpp"

namespace crumble {
namespace {

Material random_material(Random& random) {
  Material material;
  material.stiffness = std::pow(10.0, random.uniform(0, 4));
  material.damping_ratio = random.uniform() < 0.3 ? 0 : random.uniform(0, 30);
  return material;
}

TEST(Loose, FallsLikeAStoneWhateverItsDrag) {
  for (const Precision precision : {Precision::float64, Precision::float32}) {
    Loose body(small_box(), kTau, precision);
    const Vec3 start = body.center(), g(0, -9.81, 0);
    body.weigh(g);
    const int steps = 143;  // 10 cm
    for (int s = 0; s < steps; ++s) body.step();
    const double t = steps * kTau, tolerance = precision == Precision::float64 ? 1e-12 : 2e-7;
    EXPECT_NEAR(norm(body.center() - (start + 0.5 * t * t * g)), 0, tolerance);
    EXPECT_NEAR(norm(body.momentum() / body.mass() - t * g), 0, 100 * tolerance);
    for (std::size_t i = 0; i < body.positions.size(); ++i) {
      EXPECT_NEAR(norm(body.positions[i] - body.mesh.positions[i] - 0.5 * t * t * g), 0, 10 * tolerance);
    }
  }
}

TEST(Loose, DragTouchesNoMomentum) {
  Random random(3);
  for (int n = 0; n < 40; ++n) {
    Loose body(small_box(), random.uniform(1e-4, 1e-2), Precision::float64, random_material(random));
    body.shake(random, 1, 1, random_vector(random, 50));
    const Vec3 momentum = body.momentum(), angular = body.angular_momentum();
    for (int s = 0; s < 100; ++s) body.step();
    EXPECT_LE(norm(body.momentum() - momentum), 1e-11 * norm(momentum));
    EXPECT_LE(norm(body.angular_momentum() - angular), 1e-11 * norm(angular));
  }
}

// What is left when all drag has done its work: the energy of the rigid motion.
TEST(Loose, DragLeavesARigidMotion) {
  Random random(5);
  Loose body(small_box());
  body.shake(random, 0.05, 0.1, Vec3(1, 2, 0.5));
  for (int s = 0; s < 60000; ++s) body.solver->solve({});
  body.read();
  const Vec3 angular = body.angular_momentum(), center = body.center(), velocity = body.momentum() / body.mass();
  Mat3 inertia = Mat3::Zero();
  for (std::size_t i = 0; i < body.positions.size(); ++i) {
    const Vec3 r = body.positions[i] - center;
    inertia += body.network.masses[i] * (squared_norm(r) * Mat3::Identity() - r * r.transpose());
  }
  const Vec3 spin = inertia.inverse() * angular;
  EXPECT_GT(norm(spin), 0.3);
  for (std::size_t i = 0; i < body.positions.size(); ++i) {
    const Vec3 rigid = velocity + cross(spin, body.positions[i] - center);
    EXPECT_LE(norm(body.velocities[i] - rigid), 1e-4 * (norm(velocity) + norm(spin) * 0.02));
  }
}

// Against Euler's equations for the rigid body, integrated by Runge and Kutta's rule.
TEST(Loose, TumblesAsEulerSays) {
  Material stiff;
  stiff.stiffness = 1e4;
  Loose body(make_lattice_box({0.01, 0.02, 0.04}, 0.01), kTau, Precision::float64, stiff);
  Random random(1);
  const Vec3 spin(3, 20, 2);  // about the middle axis: it turns over
  for (std::uint32_t i = 0; i < body.mesh.node_count(); ++i) {
    const Vec3 at = body.mesh.positions[i];
    body.solver->place(i, at, cross(spin, at - body.center()));
  }
  body.read();
  const Vec3 center = body.center();
  Mat3 inertia = Mat3::Zero();
  for (std::size_t i = 0; i < body.positions.size(); ++i) {
    const Vec3 r = body.positions[i] - center;
    inertia += body.network.masses[i] * (squared_norm(r) * Mat3::Identity() - r * r.transpose());
  }
  const Mat3 inverse = inertia.inverse();
  const auto rate = [&](const Vec3& w) { return Vec3(-inverse * cross(w, inertia * w)); };
  Vec3 w = spin;  // in the body's axes
  Mat3 turn = Mat3::Identity();
  const int fine = 20;
  for (int s = 0; s < 500; ++s) {
    body.solver->solve({});
    for (int f = 0; f < fine; ++f) {
      const double h = kTau / fine;
      const Vec3 a = rate(w), b = rate(w + 0.5 * h * a), c = rate(w + 0.5 * h * b), d = rate(w + h * c);
      const Vec3 mean = w + h / 6 * (a + b + c);  // of w over the step, to third order
      w += h / 6 * (a + 2 * b + 2 * c + d);
      turn = turn * rotation_matrix(axis_angle(normalized(mean), h * norm(mean)));
    }
  }
  body.read();
  double worst = 0;
  for (std::size_t i = 0; i < body.positions.size(); ++i) {
    const Vec3 there = center + turn * (body.mesh.positions[i] - center);
    worst = std::max(worst, norm(body.positions[i] - there));
  }
  EXPECT_LE(worst, 5e-4);  // of 20 mm, after ten radians
}

TEST(Loose, OneNodeAndTwoMoveAsTheyShould) {
  Loose one(small_box());
  const Vector<std::uint32_t> first{0, 1, 3}, nodes{5, 0, 1};
  one.solver->set_loose({first, nodes});
  const SpringNetwork& network = one.network;
  for (std::uint32_t s = 0; s < network.spring_count(); ++s) {  // 0 and 1 stay joined
    if (network.springs[s] != Edge{0, 1}) one.solver->set_share(s, 0);
  }
  one.solver->place(5, Vec3(1, 1, 1), Vec3(0.5, 0, 0));
  const Vec3 p0 = one.mesh.positions[0], p1 = one.mesh.positions[1];
  const double length = norm(p1 - p0), spin = 10;
  const Vec3 axis(0, 0, 1),
      middle = (network.masses[0] * p0 + network.masses[1] * p1) / (network.masses[0] + network.masses[1]);
  one.solver->place(0, p0, cross(spin * axis, p0 - middle));
  one.solver->place(1, p1, cross(spin * axis, p1 - middle));
  for (int s = 0; s < 100; ++s) one.step();
  EXPECT_NEAR(norm(one.positions[5] - Vec3(1.05, 1, 1)), 0, 1e-12);
  const Vec3 start = normalized(p1 - p0), now = normalized(one.positions[1] - one.positions[0]);
  EXPECT_NEAR(dot(start, now), std::cos(100 * kTau * spin), 1e-3);
  EXPECT_NEAR(norm(one.positions[1] - one.positions[0]), length, 1e-3 * length);
}

// Three nodes in a line, of which the rigid motion alone has the first go faster than anything may.
TEST(Loose, WhatMakesAGroupEvenIsNoNodeThatIsLost) {
  Loose body(small_box(), 1e-6);
  for (std::uint32_t s = 0; s < body.network.spring_count(); ++s) body.solver->set_share(s, 0);
  const Vector<std::uint32_t> first{0, 3}, nodes{0, 1, 2};
  body.solver->set_loose({first, nodes});
  const Vector<Vec3>& at = body.mesh.positions;
  ASSERT_EQ(norm(cross(at[1] - at[0], at[2] - at[0])), 0);
  for (const std::uint32_t node : {0u, 1u}) body.solver->place(node, at[node], 990 * Vec3::UnitZ());
  body.step();
  EXPECT_GT(norm(body.velocities[0]), 900);
  EXPECT_EQ(body.solver->lost_node(), std::nullopt);
}

TEST(Loose, NodesThatWouldLeaveTheWorldStay) {
  Loose body(small_box());
  const auto place = [&](std::uint32_t i) { return Vec3(body.mesh.positions[i] + 999.9 * Vec3::UnitX()); };
  for (std::uint32_t i = 0; i < body.mesh.node_count(); ++i) body.solver->place(i, place(i), 900 * Vec3::UnitX());
  body.step();
  EXPECT_NE(body.solver->lost_node(), std::nullopt);
  for (std::uint32_t i = 0; i < body.mesh.node_count(); ++i) {
    EXPECT_NEAR(norm(body.positions[i] - place(i)), 0, 1e-9);
    EXPECT_EQ(body.velocities[i], Vec3(Vec3::Zero()));
  }
}

// docs/numerics.md: exact as long as the body does not turn, and to the second order of spin times tau when it does.
TEST(EnergyTheoremOfLooseBodies, NeverGrowsUpTo20RadiansPerSecondAndAMillisecond) {
  Random random(7);
  for (int n = 0; n < 400; ++n) {
    const double tau = random.uniform(1e-4, 1e-3);
    Loose body(small_box(), tau, Precision::float64, random_material(random));
    const double share = std::pow(10.0, random.uniform(-5, 0.3));
    body.shake(random, share, share, random_vector(random, n % 2 == 0 ? 0 : 20));
    const double reference = reference_energy(body.network);
    for (int s = 0; s < 30; ++s) {
      const double before = body.energy();
      body.step();
      ASSERT_LE(body.energy() - before, 1e-12 * (before + reference));
    }
  }
}

TEST(EnergyTheoremOfLooseBodies, WithoutSpinItHoldsAtAnyTimeStep) {
  Random random(11);
  for (int n = 0; n < 800; ++n) {
    Loose body(small_box(), random.uniform(1e-4, 0.01), Precision::float64, random_material(random));
    const double reference = reference_energy(body.network);
    for (int state = 0; state < 30; ++state) {
      const double share = std::pow(10.0, random.uniform(-5, 0.3));
      body.shake(random, share, 3 * share, Vec3::Zero());
      const Vec3 center = body.center(), angular = body.angular_momentum();
      Mat3 inertia = Mat3::Zero();
      for (std::size_t i = 0; i < body.positions.size(); ++i) {
        const Vec3 r = body.positions[i] - center;
        inertia += body.network.masses[i] * (squared_norm(r) * Mat3::Identity() - r * r.transpose());
      }
      const Vec3 spin = inertia.inverse() * angular;
      for (std::uint32_t i = 0; i < body.positions.size(); ++i) {
        const Vec3 r = body.positions[i] - center;
        body.solver->place(i, body.positions[i], body.velocities[i] - cross(spin, r));
      }
      body.read();
      const double before = body.energy();
      body.step();
      ASSERT_LE(body.energy() - before, 1e-12 * (before + reference));
    }
  }
}

// At 400 rad/s and 10 ms, four radians a step, it does grow: the bounds above are not empty.
TEST(EnergyTheoremOfLooseBodies, TheTestHasTeeth) {
  Random random(7);
  int growing = 0;
  for (int n = 0; n < 100; ++n) {
    Loose body(small_box(), 0.01, Precision::float64, random_material(random));
    body.shake(random, 0.1, 0.1, random_vector(random, 400));
    const double before = body.energy();
    body.step();
    growing += body.energy() > before * (1 + 1e-6);
  }
  EXPECT_GT(growing, 5);
}

// Held at one node it swings about it, held at three it stops.
TEST(Loose, AHeldNodeBrakesItsBody) {
  for (const std::size_t count : {1u, 3u}) {
    Loose body(small_box());
    for (std::uint32_t i = 0; i < body.mesh.node_count(); ++i) {
      body.solver->place(i, body.mesh.positions[i], Vec3(0, -0.1, 0));
    }
    Vector<NodeConstraint> constraints(count);
    for (std::size_t k = 0; k < count; ++k) {
      NodeConstraint& held = constraints[k];
      held.node = k < 2 ? static_cast<std::uint32_t>(k) : static_cast<std::uint32_t>(body.mesh.node_count() - 1);
      held.normal = Vec3::UnitY(), held.state = ContactState::attached;
      held.point = body.mesh.positions[held.node];
      body.solver->place(held.node, held.point, Vec3::Zero());
    }
    for (int s = 0; s < 3000; ++s) body.solver->solve(constraints);
    body.read();
    for (const NodeConstraint& held : constraints) EXPECT_EQ(body.positions[held.node], held.point);
    const double left = norm(body.momentum()) / (body.mass() * 0.1);
    if (count == 3) {
      EXPECT_LT(left, 1e-3);
    } else {
      EXPECT_GT(left, 0.3);
      const Vec3 center = body.center(), r = body.positions[0] - center, velocity = body.momentum() / body.mass();
      EXPECT_LT(std::abs(dot(velocity, r)), 1e-2 * norm(velocity) * norm(r));
    }
  }
}

TEST(SpringDampers, TwoNodesLoseTheSpeedBetweenThemAsTheClosedFormSays) {
  Material material;
  material.stiffness = 1e-12, material.damping_ratio = 0, material.spring_damping = 0.02;
  Loose body(small_box(), kTau, Precision::float64, material);
  const auto [a, b] = body.network.springs[0];
  for (std::uint32_t s = 1; s < body.network.spring_count(); ++s) body.solver->set_share(s, 0);
  const Vector<std::uint32_t> first{0, 2}, nodes{a, b};
  body.solver->set_loose({first, nodes});
  const Vec3 along = normalized(body.mesh.positions[b] - body.mesh.positions[a]);
  body.solver->place(b, body.mesh.positions[b], 0.001 * along + Vec3(0, 0, 0));
  body.step();
  const double ma = body.network.masses[a], mb = body.network.masses[b], both = ma * mb / (ma + mb);
  const double left = dot(body.velocities[b] - body.velocities[a], along);
  EXPECT_NEAR(left, 0.001 * std::exp(-material.spring_damping * kTau / both), 1e-12);
  EXPECT_NEAR(norm(ma * body.velocities[a] + mb * body.velocities[b] - mb * 0.001 * along), 0, 1e-14);
}

TEST(SpringDampers, TakeEnergyAndNoMomentum) {
  Random random(9);
  for (int n = 0; n < 100; ++n) {
    Material material = random_material(random);
    material.spring_damping = std::pow(10.0, random.uniform(-4, 2));
    Loose body(small_box(), random.uniform(1e-4, 1e-3), Precision::float64, material);
    body.shake(random, 0.5, 1, Vec3::Zero());
    const double reference = reference_energy(body.network);
    for (int s = 0; s < 20; ++s) {
      const double before = body.energy();
      const Vec3 before_p = body.momentum(), before_l = body.angular_momentum();
      body.step();
      ASSERT_LE(body.energy() - before, 1e-12 * (before + reference));
      ASSERT_LE(norm(body.momentum() - before_p), 1e-13);
      ASSERT_LE(norm(body.angular_momentum() - before_l), 1e-14);
    }
  }
}

TEST(Loose, EveryKernelGivesTheSameBits) {
  for (const Precision precision : {Precision::float64, Precision::float32}) {
    Vector<std::uint64_t> hashes;
    for (const std::string& kernel : kernel_names()) {
      Random random(2);
      Loose body(small_box());
      body.solver = NetworkSolver::make(body.network, make_coefficients(body.network, kTau, TimeStepPolicy::guard),
                                        body.mesh.positions, settings_of(precision, kernel));
      const Vector<std::uint32_t> first{0, 4, 9}, nodes{1, 3, 5, 7, 0, 2, 4, 6, 8};
      body.solver->set_loose({first, nodes});
      body.shake(random, 0.3, 1, Vec3(3, 2, 1));
      for (int s = 0; s < 50; ++s) body.solver->solve({});
      Hash hash;
      body.solver->add_to(hash);
      hashes.push_back(hash.value());
    }
    for (const std::uint64_t hash : hashes) EXPECT_EQ(hash, hashes[0]);
  }
}

}  // namespace
}  // namespace crumble
