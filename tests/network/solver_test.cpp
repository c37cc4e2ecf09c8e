#include "crumble/network/solver.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "crumble/base/error.hpp"
#include "crumble/base/memory.hpp"
#include "crumble/network/energy.hpp"
#include "network/two_nodes.hpp"
#include "network/violence.hpp"

namespace crumble {
namespace {

TEST(Forces, AreTheNegativeGradientOfTheSpringEnergy) {
  const TetMesh mesh = make_lattice_box({0.02, 0.02, 0.02}, 0.01);
  const SpringNetwork network = make_network(mesh, {}, MassRule::lumped, {});
  const auto solver =
      NetworkSolver::make(network, make_coefficients(network, 1e-3, TimeStepPolicy::guard), mesh.positions, {});
  Random random(1);
  VecArray positions(mesh.positions);
  for (std::uint32_t i = 0; i < mesh.node_count(); ++i) {
    positions.set(i, positions[i] + random_vector(random, 0.003));
    solver->place(i, positions[i], Vec3::Zero());
  }
  Vector<double> stiffnesses = network.stiffnesses;
  stiffnesses[5] = 0, stiffnesses[8] *= 0.25;
  solver->set_share(5, 0), solver->set_share(8, 0.25);
  const VecArray forces = forces_of(*solver);
  const double h = 1e-7;
  for (std::size_t i = 0; i < mesh.node_count(); ++i) {
    const double at = positions.y[i];
    positions.y[i] = at + h;
    const double more = spring_energy(network, positions, stiffnesses);
    positions.y[i] = at - h;
    const double less = spring_energy(network, positions, stiffnesses);
    positions.y[i] = at;
    EXPECT_NEAR(forces.y[i], -(more - less) / (2 * h), 1e-8);
  }
}

TEST(Forces, ZeroLengthPullsNowhere) {
  const TwoNodes pair(1, 1, 30, 1);
  for (const Precision precision : {Precision::float64, Precision::float32}) {
    const auto solver = NetworkSolver::make(pair.network, make_coefficients(pair.network, 1e-3, TimeStepPolicy::guard),
                                            pair.rest, settings_of(precision));
    for (const double length : {0.0, precision == Precision::float32 ? 1e-20 : 1e-160, 1e-300}) {
      solver->place(1, {length, 0, 0}, Vec3::Zero());
      EXPECT_EQ(norm(forces_of(*solver)[1]), 0) << length;
      solver->solve({});
      EXPECT_NEAR(solver->position(1).x(), length, 1e-14 * length + (precision == Precision::float32 ? 1e-44 : 0));
    }
  }
}

TEST(Solver, EveryFreeNodeKeepsItsMomentumBalance) {
  const TetMesh mesh = make_lattice_box({0.02, 0.02, 0.02}, 0.01);
  Random random(11);
  for (int i = 0; i < 300; ++i) {
    Violence v(mesh, random, random.uniform(1, 30));
    const double tau = 1e-3;
    const StepCoefficients c = make_coefficients(v.network, tau, TimeStepPolicy::guard);
    const auto solver = NetworkSolver::make(v.network, c, v.rest, {});
    v.put(*solver);
    const VecArray forces = forces_of(*solver);
    solver->solve(v.constraints);
    double force_sum = 0;
    Vec3 net = Vec3::Zero();
    Vector<Vec3> reaction(v.rest.size(), Vec3::Zero()), normal = reaction;
    Vector<int> moves(v.rest.size(), 1);
    for (std::size_t n = 0; n < v.rest.size(); ++n) {
      force_sum += norm(forces[n]);
      net += forces[n] - v.external[n];
      moves[n] = v.network.fixed[n] == 0;
    }
    EXPECT_LE(norm(net), 1e-10 * force_sum);  // springs pull in pairs
    for (const auto& k : v.constraints) {
      reaction[k.node] = k.reaction;
      if (k.state == ContactState::slip) normal[k.node] = k.normal;  // balanced along the surface only
      if (k.state == ContactState::stick) moves[k.node] = 0;
    }
    for (std::uint32_t n = 0; n < v.rest.size(); ++n) {
      if (!moves[n]) continue;
      const Vec3 change = v.network.masses[n] * (solver->velocity(n) - v.velocities[n]) +
                          c.drags[n] * (solver->position(n) - v.positions[n]);
      Vec3 left = change - tau * (forces[n] + reaction[n]);
      left -= dot(left, normal[n]) * normal[n];
      EXPECT_LE(norm(left), 1e-10 * force_sum);
    }
  }
}

TEST(Contacts, StickSlipReleaseByTheCone) {
  const auto filter = [&](const Vec3& force, ContactState before) {
    NodeConstraint c;
    c.normal = Vec3::UnitY();
    c.static_friction = 3;
    c.dynamic_friction = 1.5;
    c.state = before;
    filter_contact(c, force);
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
  const TetMesh mesh = make_lattice_box({0.02, 0.02, 0.02}, 0.01);
  Random random(17);
  int carried = 0, dragged = 0;
  for (int i = 0; i < 2000; ++i) {
    Violence v(mesh, random, random.uniform(0, 30));
    const double tau = 1e-3;
    const auto solver =
        NetworkSolver::make(v.network, make_coefficients(v.network, tau, TimeStepPolicy::guard), v.rest, {});
    v.put(*solver);
    const VecArray forces = forces_of(*solver);
    solver->solve(v.constraints);
    for (const NodeConstraint& c : v.constraints) {
      const Vec3 force = forces[c.node];
      const double pressing = -dot(force, c.normal);
      const Vec3 friction = c.reaction - pressing * c.normal;
      if (c.state == ContactState::slip) {
        const Vec3 past = solver->position(c.node) - v.positions[c.node] - tau * c.velocity;
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

TEST(Solver, ReadsAnyRangeOfPositionsByNode) {
  Random random(3);
  const TetMesh mesh = shuffled(make_lattice_box({0.02, 0.02, 0.02}, 0.002), random);
  const SpringNetwork network = make_network(mesh, {}, MassRule::lumped, {});
  const auto n = static_cast<std::uint32_t>(mesh.node_count());
  for (const Precision precision : {Precision::float64, Precision::float32}) {
    const auto solver = NetworkSolver::make(network, make_coefficients(network, 1e-3, TimeStepPolicy::guard),
                                            mesh.positions, settings_of(precision));
    ASSERT_TRUE(solver->layout().sorted);  // has numbered the nodes anew
    for (std::uint32_t i = 0; i < n; ++i) {
      solver->place(i, mesh.positions[i] + random_vector(random, 0.001), Vec3::Zero());
    }
    for (const auto& [first, count] : {std::pair{0u, n}, {0u, 1u}, {17u, 90u}, {n - 1, 1u}, {n, 0u}}) {
      VecArray read(count);
      solver->read_positions(first, read);
      for (std::uint32_t i = 0; i < count; ++i) EXPECT_EQ(read[i], solver->position(first + i)) << first + i;
    }
  }
}

// Powers of two: lengths and limits are exact, so "exactly at the limit" means that.
TEST(Overlong, LongerThanTheLimitOnlyAndIntactOnly) {
  for (const Precision precision : {Precision::float64, Precision::float32}) {
    TwoNodes pair(1, 1, 32, 1);
    pair.network.fixed = {0, 0};
    const auto solver = NetworkSolver::make(pair.network, make_coefficients(pair.network, 1e-3, TimeStepPolicy::guard),
                                            pair.rest, settings_of(precision, "", 2, 0.25));
    const auto reported = [&](double length, double share) {
      solver->place(0, Vec3::Zero(), Vec3::Zero());
      solver->place(1, {0, length, 0}, Vec3::Zero());
      solver->set_share(0, share);
      solver->solve({});
      return solver->overlong().size();
    };
    EXPECT_EQ(reported(1, 1), 0u);
    EXPECT_EQ(reported(0.125, 1), 0u);
    EXPECT_EQ(reported(0, 1), 0u);
    EXPECT_EQ(reported(2, 1), 0u);
    EXPECT_EQ(reported(2.0625, 1), 1u);
    EXPECT_EQ(solver->overlong()[0], 0u);
    EXPECT_EQ(reported(2.0625, 0), 0u);
    EXPECT_EQ(reported(2.0625, 0.5), 0u);
    EXPECT_EQ(reported(4, 1), 1u);
    // the one that is reported has cut_share of its force already, the one that fades what it was given
    const double gain = make_coefficients(pair.network, 1e-3, TimeStepPolicy::guard).force_gain[1];
    EXPECT_NEAR(4 - solver->position(1).y(), gain * 0.25 * 32 * 3, 1e-6 * gain);
    EXPECT_EQ(reported(4, 0.5), 0u);
    EXPECT_NEAR(4 - solver->position(1).y(), gain * 0.5 * 32 * 3, 1e-5 * gain);
  }
}

TEST(Overlong, NoneAtRestAtATightLimitAndNoneWithoutALimit) {
  Random random(5);
  for (const Body& body : small_bodies()) {
    const SpringNetwork network = make_network(body.mesh, {}, MassRule::lumped, {});
    const auto c = make_coefficients(network, 1e-3, TimeStepPolicy::guard);
    for (const Precision precision : {Precision::float64, Precision::float32}) {
      const double limit = precision == Precision::float32 ? 1 + 2e-5 : 1 + 1e-13;
      const auto tight = NetworkSolver::make(network, c, body.mesh.positions, settings_of(precision, "", limit));
      tight->solve({});
      EXPECT_TRUE(tight->overlong().empty()) << body.name;
      const auto none = NetworkSolver::make(network, c, body.mesh.positions, settings_of(precision));
      for (std::uint32_t i = 0; i < body.mesh.node_count(); ++i) none->place(i, random_vector(random, 1), Vec3::Zero());
      none->solve({});
      EXPECT_TRUE(none->overlong().empty()) << body.name;
    }
  }
}

TEST(Solver, ANodeThatWouldLeaveTheWorldStays) {
  const TetMesh mesh = make_lattice_box({0.02, 0.02, 0.02}, 0.01);
  const SpringNetwork network = make_network(mesh, {}, MassRule::lumped, {});
  const auto c = make_coefficients(network, 1e-3, TimeStepPolicy::guard);
  for (const Precision precision : {Precision::float64, Precision::float32}) {
    const auto solver = NetworkSolver::make(network, c, mesh.positions, settings_of(precision));
    for (const double force : {std::nan(""), std::numeric_limits<double>::infinity(), 1e30}) {
      VecArray external(mesh.node_count());
      external.x[7] = force;
      solver->reset();
      solver->set_external(external);
      const Vec3 at = solver->position(7);
      solver->solve({});
      EXPECT_EQ(solver->lost_node(), std::optional<std::uint32_t>(7));
      EXPECT_EQ(solver->position(7), at);
      EXPECT_EQ(norm(solver->velocity(7)), 0);
      external.x[7] = 0;
      solver->set_external(external);
      solver->solve({});
      EXPECT_FALSE(solver->lost_node().has_value());
    }
  }
}

TEST(Solver, RefusesBadSettingsByName) {
  const TwoNodes pair(1, 1, 30, 1);
  const auto message = [&](const SolverSettings& settings) {
    try {
      const auto c = make_coefficients(pair.network, 1e-3, TimeStepPolicy::guard);
      NetworkSolver::make(pair.network, c, pair.rest, settings);
    } catch (const Error& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  EXPECT_EQ(message({}), "");
  constexpr Precision kDouble = Precision::float64;
  EXPECT_NE(message(settings_of(kDouble, "sse99")).find("sse99"), std::string::npos);
  EXPECT_NE(message(settings_of(kDouble, "", std::nan(""))).find("length_limit"), std::string::npos);
  EXPECT_NE(message(settings_of(kDouble, "", 0.5)).find("length_limit"), std::string::npos);
  EXPECT_NE(message(settings_of(kDouble, "", 2, 1.5)).find("cut_share"), std::string::npos);
  SolverSettings settings;
  settings.threads = 0;
  EXPECT_NE(message(settings).find("threads"), std::string::npos);
}

TEST(Solver, AFrozenNodeStaysAtRestAndIsFreeAgain) {
  for (const Precision precision : {Precision::float64, Precision::float32}) {
    const TetMesh mesh = make_lattice_box({0.02, 0.02, 0.02}, 0.01);
    const SpringNetwork network = make_network(mesh, {}, MassRule::lumped, {});
    const StepCoefficients coefficients = make_coefficients(network, 1e-3, TimeStepPolicy::guard);
    const auto solver = NetworkSolver::make(network, coefficients, mesh.positions, settings_of(precision));
    // the same as fixing it from the start
    const std::uint32_t node = 13;
    const SpringNetwork with_fixed = make_network(mesh, {}, MassRule::lumped, std::span(&node, 1));
    const auto fixed = NetworkSolver::make(with_fixed, make_coefficients(with_fixed, 1e-3, TimeStepPolicy::guard),
                                           mesh.positions, settings_of(precision));
    solver->set_frozen(node, true);
    for (const auto& each : {solver.get(), fixed.get()}) {
      for (std::uint32_t i = 0; i < mesh.node_count(); ++i) {
        each->place(i, mesh.positions[i] * 1.05, i == node ? Vec3::Zero() : Vec3(0.01, 0.02, -0.01));
      }
      for (int step = 0; step < 100; ++step) each->solve({});
    }
    for (std::uint32_t i = 0; i < mesh.node_count(); ++i) {
      EXPECT_EQ(solver->position(i), fixed->position(i));
      EXPECT_EQ(solver->velocity(i), fixed->velocity(i));
    }
    EXPECT_EQ(solver->velocity(node), Vec3::Zero());
    const auto copy = solver->clone();
    const Vec3 before = copy->position(node);
    copy->solve({});
    EXPECT_EQ(copy->position(node), before) << "a copy knows";
    solver->set_frozen(node, false);
    for (int step = 0; step < 10; ++step) solver->solve({});
    EXPECT_NE(solver->position(node), before);
  }
}

}  // namespace
}  // namespace crumble
