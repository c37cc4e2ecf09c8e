#include "crumble/network/solver.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "crumble/base/random.hpp"
#include "crumble/network/energy.hpp"
#include "crumble/tetmesh/lattice_box.hpp"
#include "network/two_nodes.hpp"

namespace crumble {
namespace {

Vec3 random_vector(Random& random, double size) {
  return size * Vec3(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1));
}

TEST(Forces, AreTheNegativeGradientOfTheSpringEnergy) {
  const TetMesh mesh = make_lattice_box({0.02, 0.02, 0.02}, 0.01);
  const SpringNetwork network = make_network(mesh, {}, MassRule::lumped, {});
  NetworkState state = make_rest_state(mesh, network);
  Random random(1);
  for (std::size_t i = 0; i < mesh.node_count(); ++i)
    state.positions.set(i, state.positions[i] + random_vector(random, 0.003));
  state.stiffnesses[5] = 0;
  sum_forces(network, state);
  const double h = 1e-7;
  for (std::size_t i = 0; i < mesh.node_count(); ++i) {
    const double at = state.positions.y[i];
    state.positions.y[i] = at + h;
    const double more = spring_energy(network, state);
    state.positions.y[i] = at - h;
    const double less = spring_energy(network, state);
    state.positions.y[i] = at;
    EXPECT_NEAR(state.forces.y[i], -(more - less) / (2 * h), 1e-8);
  }
}

TEST(Forces, ZeroLengthPullsNowhere) {
  TwoNodes pair(1, 1, 30, 1);
  for (const double length : {0.0, 1e-160, 1e-300}) {
    pair.state.positions.x[1] = length;
    sum_forces(pair.network, pair.state);
    EXPECT_EQ(norm(pair.state.forces[1]), 0) << length;
  }
}

// A violent random state, inverted and torn, with held, sliding and fixed nodes and wild masses.
struct Violence {
  TetMesh mesh = make_lattice_box({0.02, 0.02, 0.02}, 0.01);
  SpringNetwork network;
  NetworkState state;
  std::vector<NodeConstraint> constraints;

  Violence(Random& random, double damping_ratio) {
    Material material;
    material.stiffness = std::pow(10.0, random.uniform(0, 4));
    material.damping_ratio = damping_ratio;
    const std::vector<std::uint32_t> fixed{0, 5};
    network = make_network(mesh, material, MassRule::lumped, fixed);
    for (std::size_t i = 0; i < network.node_count(); ++i) {
      const double heavier = std::pow(10.0, random.uniform(-2, 2));
      network.masses[i] *= heavier;
      network.drags[i] *= std::sqrt(heavier);
    }
    state = make_rest_state(mesh, network);
    for (std::size_t i = 0; i < mesh.node_count(); ++i) {
      if (network.fixed[i]) continue;
      state.positions.set(i, random_vector(random, 0.03));
      state.velocities.set(i, random_vector(random, 3));
      state.external.set(i, random_vector(random, 0.1));
    }
    if (random.uniform() < 0.1) state.positions.set(3, state.positions[4]);  // a spring of length zero
    for (double& k : state.stiffnesses)
      k *= random.uniform() < 0.8 ? 1 : 0.5 * static_cast<double>(random.below(2));  // cut or fading
    for (std::uint32_t node = 10; node < 20; ++node) {
      NodeConstraint c;
      c.node = node;
      c.normal = normalized(random_vector(random, 1));
      c.static_friction = random.uniform(0, 2);
      c.dynamic_friction = c.static_friction * random.uniform();
      c.state = static_cast<ContactState>(random.below(3));
      c.velocity = random_vector(random, std::pow(10.0, random.uniform(-3, 1)));
      constraints.push_back(c);
    }
  }

  // growth of springs + kinetic energy in one solve, less the work of reactions and external forces, over the scale
  double relative_growth(const StepCoefficients& coefficients) {
    const double before = spring_energy(network, state) + kinetic_energy(network, state);
    const VecArray from = state.positions;
    ExponentialSolver solver(network.node_count());
    solver.solve(network, coefficients, state, constraints);
    double work = 0;
    for (std::size_t i = 0; i < from.size(); ++i) work += dot(state.external[i], state.positions[i] - from[i]);
    for (const NodeConstraint& c : constraints) work += dot(c.reaction, state.positions[c.node] - from[c.node]);
    const double after = spring_energy(network, state) + kinetic_energy(network, state);
    return (after - before - work) / (before + reference_energy(network));
  }
};

TEST(EnergyTheorem, NoPolicyThatPromisesItEverGainsEnergy) {
  for (const TimeStepPolicy policy : {TimeStepPolicy::guard, TimeStepPolicy::substep, TimeStepPolicy::error}) {
    Random random(7);
    double worst = -1;
    for (int i = 0; i < 24000; ++i) {
      const bool guard = policy == TimeStepPolicy::guard;
      Violence v(random, guard ? random.uniform(0, 30) : random.uniform(5, 60));
      const double certified = make_coefficients(v.network, 1e-4, TimeStepPolicy::guard).certified_time_step;
      double tau = random.uniform(1e-4, 0.01);
      if (policy == TimeStepPolicy::substep) tau = std::min(tau, 60 * certified);
      if (policy == TimeStepPolicy::error) tau = std::min(tau, certified * random.uniform(0.5, 1));
      worst = std::max(worst, v.relative_growth(make_coefficients(v.network, tau, policy)));
    }
    EXPECT_LE(worst, 1e-12) << "policy " << static_cast<int>(policy);
  }
}

TEST(EnergyTheorem, TheTestHasTeeth) {
  Random random(7);
  int growing = 0;
  for (int i = 0; i < 2000; ++i) {
    Violence v(random, 1);
    growing += v.relative_growth(make_coefficients(v.network, 0.01, TimeStepPolicy::unchecked)) > 1e-12;
  }
  EXPECT_GT(growing, 100);
}

TEST(Solver, EveryFreeNodeKeepsItsMomentumBalance) {
  Random random(11);
  for (int i = 0; i < 500; ++i) {
    Violence v(random, random.uniform(1, 30));
    const double tau = 1e-3;
    const StepCoefficients c = make_coefficients(v.network, tau, TimeStepPolicy::guard);
    const NetworkState before = v.state;
    ExponentialSolver solver(v.network.node_count());
    solver.solve(v.network, c, v.state, v.constraints);
    double force_sum = 0;
    Vec3 net = Vec3::Zero();
    for (std::size_t n = 0; n < before.positions.size(); ++n) {
      force_sum += norm(v.state.forces[n]);
      net += v.state.forces[n] - v.state.external[n];
    }
    EXPECT_LE(norm(net), 1e-10 * force_sum);  // springs pull in pairs
    std::vector<Vec3> reaction(before.positions.size(), Vec3::Zero());
    std::vector<int> free(before.positions.size(), 1);
    for (const auto& k : v.constraints) {
      reaction[k.node] = k.reaction;
      free[k.node] = k.state != ContactState::stick;
    }
    for (std::size_t n = 0; n < before.positions.size(); ++n) {
      if (v.network.fixed[n] || !free[n]) continue;
      const Vec3 change = v.network.masses[n] * (v.state.velocities[n] - before.velocities[n]) +
                          c.drags[n] * (v.state.positions[n] - before.positions[n]);
      Vec3 rest = change - tau * (v.state.forces[n] + reaction[n]);
      for (const auto& k : v.constraints) {  // a sliding node is balanced along the surface only
        if (k.node == n && k.state == ContactState::slip) rest -= dot(rest, k.normal) * k.normal;
      }
      EXPECT_LE(norm(rest), 1e-10 * force_sum);
    }
  }
}

TEST(Contacts, StickSlipReleaseByTheCone) {
  VecArray forces(1);
  const auto filter = [&](const Vec3& force, ContactState before) {
    forces.set(0, force);
    NodeConstraint c;
    c.normal = Vec3::UnitY();
    c.static_friction = 3;
    c.dynamic_friction = 1.5;
    c.state = before;
    filter_contacts({&c, 1}, forces);
    return c;
  };
  using S = ContactState;
  EXPECT_EQ(filter({0, 0.1, 0}, S::stick).state, S::released);
  EXPECT_EQ(filter({0, 0, 0}, S::stick).state, S::released);
  EXPECT_EQ(filter({2.9, -1, 0}, S::fresh).state, S::stick);
  EXPECT_EQ(filter({2.9, -1, 0}, S::slip).state, S::slip);  // dynamic friction does not hold it
  EXPECT_EQ(filter({1.4, -1, 0}, S::slip).state, S::stick);
  EXPECT_EQ(filter({3.1, -1, 0}, S::stick).state, S::slip);
  EXPECT_LT(norm(filter({2.9, -1, 0}, S::stick).reaction - Vec3(-2.9, 1, 0)), 1e-15);
  EXPECT_LT(norm(filter({3.1, -1, 0}, S::stick).reaction - Vec3(-1.5, 1, 0)), 1e-15);
}

// Whatever the tool does: friction takes energy out of the sliding, never puts it in.
TEST(Contacts, FrictionOpposesSlidingPastTheSurface) {
  Random random(17);
  int carried = 0, dragged = 0;
  for (int i = 0; i < 2000; ++i) {
    Violence v(random, random.uniform(0, 30));
    const double tau = 1e-3;
    const VecArray from = v.state.positions;
    ExponentialSolver solver(v.network.node_count());
    solver.solve(v.network, make_coefficients(v.network, tau, TimeStepPolicy::guard), v.state, v.constraints);
    for (const NodeConstraint& c : v.constraints) {
      const Vec3 force = v.state.forces[c.node];
      const double pressing = -dot(force, c.normal);
      const Vec3 friction = c.reaction - pressing * c.normal;
      if (c.state == ContactState::slip) {
        const Vec3 past = v.state.positions[c.node] - from[c.node] - tau * c.velocity;
        ASSERT_LE(dot(friction, past), 1e-12 * norm(friction) * norm(past));
        ASSERT_NEAR(norm(friction), c.dynamic_friction * pressing, 1e-9 * pressing);
        dragged += dot(friction, force) > 0;
      } else if (c.state == ContactState::stick) {
        ASSERT_LE(norm(friction), c.static_friction * pressing * (1 + 1e-12));  // within the cone
        carried += norm(force + pressing * c.normal) > c.static_friction * pressing;
      }
    }
  }
  EXPECT_GT(carried, 20);
  EXPECT_GT(dragged, 100);
}

TEST(Solver, NeverNaNAtAnyMaterialUnderTheGuard) {
  Random random(13);
  for (int i = 0; i < 60; ++i) {
    Violence v(random, i % 10 == 0 ? 0 : random.uniform(0, 100));
    const StepCoefficients c = make_coefficients(v.network, random.uniform(1e-4, 0.01), TimeStepPolicy::guard);
    ExponentialSolver solver(v.network.node_count());
    for (std::size_t n = 0; n < v.state.external.size(); ++n) v.state.external.set(n, Vec3::Zero());
    const double energy = spring_energy(v.network, v.state) + kinetic_energy(v.network, v.state);
    for (int step = 0; step < 1000; ++step) solver.solve(v.network, c, v.state, {});
    for (std::size_t n = 0; n < v.state.positions.size(); ++n) {
      // bounded by the energy: m v^2 / 2 cannot exceed what was there
      ASSERT_TRUE(is_finite(v.state.positions[n]));
      ASSERT_LE(0.5 * v.network.masses[n] * squared_norm(v.state.velocities[n]), energy * (1 + 1e-9));
    }
  }
}

}  // namespace
}  // namespace crumble
