// The energy theorem of docs/numerics.md: under a policy that promises it, springs + kinetic energy do not grow in a
// step, whatever the state. Seen in both precisions; the steps are shared among the kernels, which all give the same
// bits (kernels_test.cpp).
#include "crumble/network/energy.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "crumble/base/memory.hpp"
#include "network/violence.hpp"

namespace crumble {
namespace {

struct Energy {
  double scale = 0;   // H, springs + kinetic before the solve: what was too long already pulls less
  double growth = 0;  // in the solve, less the work of reactions and outer forces
};

Energy measure(const Violence& v, const SolverSettings& settings, NetworkSolver& solver) {
  v.put(solver);
  const std::size_t nodes = v.rest.size();
  VecArray from(nodes), velocities(nodes), to(nodes);
  solver.read_positions(0, from), solver.read_velocities(velocities);
  const double kinetic = kinetic_energy(v.network, velocities);
  Vector<NodeConstraint> constraints = v.constraints;
  solver.solve(constraints);
  solver.read_positions(0, to), solver.read_velocities(velocities);

  Vector<double> stiffnesses = v.network.stiffnesses;
  for (std::size_t s = 0; s < stiffnesses.size(); ++s) stiffnesses[s] *= v.shares[s];
  for (const std::uint32_t s : solver.overlong()) stiffnesses[s] *= settings.cut_share;
  double work = 0;
  for (std::size_t i = 0; i < nodes; ++i) work += dot(v.external[i], to[i] - from[i]);
  for (const NodeConstraint& c : constraints) work += dot(c.reaction, to[c.node] - from[c.node]);
  const double before = spring_energy(v.network, from, stiffnesses) + kinetic;
  const double after = spring_energy(v.network, to, stiffnesses) + kinetic_energy(v.network, velocities);
  return {before, after - before - work};
}

// Growth over what rounding may make of it; above 1 the promise is broken.
double excess(const Energy& e, double reference, Precision precision) {
  const bool is_float = precision == Precision::float32;
  return e.growth / (is_float ? 1e-6 * e.scale + 1e-9 * reference : 1e-12 * (e.scale + reference));
}

double certified(const SpringNetwork& network) {
  return make_coefficients(network, 1e-4, TimeStepPolicy::guard).certified_time_step;
}

// The worst excess over `networks` networks in 20 states each.
double worst_excess(TimeStepPolicy policy, Precision precision, int networks) {
  static const TetMesh mesh = make_lattice_box({0.02, 0.02, 0.02}, 0.01);
  const Vector<std::string> kernels = kernel_names();
  Random random(7);
  double worst = -1e300;
  for (int n = 0; n < networks; ++n) {
    Violence v(mesh, random, policy == TimeStepPolicy::guard ? random.uniform(0, 30) : random.uniform(5, 60));
    double tau = random.uniform(1e-4, 0.01);
    if (policy == TimeStepPolicy::substep) tau = std::min(tau, 60 * certified(v.network));
    if (policy == TimeStepPolicy::error) tau = std::min(tau, certified(v.network) * random.uniform(0.5, 1));
    const std::string& kernel = kernels[static_cast<std::size_t>(n) % kernels.size()];
    const double limit = n % 2 == 0 ? 0 : random.uniform(1.1, 6);
    const SolverSettings settings = settings_of(precision, kernel, limit, random.uniform());
    const auto solver = NetworkSolver::make(v.network, make_coefficients(v.network, tau, policy), v.rest, settings);
    const double reference = reference_energy(v.network);
    for (int state = 0; state < 20; ++state) {
      v.shake(random);
      worst = std::max(worst, excess(measure(v, settings, *solver), reference, precision));
      if (solver->lost_node()) return std::numeric_limits<double>::infinity();
    }
  }
  return worst;
}

TEST(EnergyTheorem, NoPolicyThatPromisesItGainsEnergyInDoubles) {
  for (const TimeStepPolicy policy : {TimeStepPolicy::guard, TimeStepPolicy::substep, TimeStepPolicy::error}) {
    EXPECT_LE(worst_excess(policy, Precision::float64, 1200), 1) << "policy " << static_cast<int>(policy);
  }
}

TEST(EnergyTheorem, NorInFloats) {
  for (const TimeStepPolicy policy : {TimeStepPolicy::guard, TimeStepPolicy::substep, TimeStepPolicy::error}) {
    EXPECT_LE(worst_excess(policy, Precision::float32, 1200), 1) << "policy " << static_cast<int>(policy);
  }
}

TEST(EnergyTheorem, TheTestHasTeeth) {
  const TetMesh mesh = make_lattice_box({0.02, 0.02, 0.02}, 0.01);
  Random random(7);
  for (const Precision precision : {Precision::float64, Precision::float32}) {
    int growing = 0;
    for (int i = 0; i < 500; ++i) {
      Violence v(mesh, random, 1);
      const SolverSettings settings = settings_of(precision);
      const auto coefficients = make_coefficients(v.network, 0.01, TimeStepPolicy::unchecked);
      const auto solver = NetworkSolver::make(v.network, coefficients, v.rest, settings);
      growing += excess(measure(v, settings, *solver), reference_energy(v.network), precision) > 1;
    }
    EXPECT_GT(growing, 25);
  }
}

// The state left alone: no energy comes in, so none is there that was not there before.
TEST(EnergyTheorem, NeverNaNAndBoundedSpeedAtAnyMaterialUnderTheGuard) {
  const TetMesh mesh = make_lattice_box({0.02, 0.02, 0.02}, 0.01);
  Random random(13);
  for (int i = 0; i < 120; ++i) {
    Violence v(mesh, random, i % 10 < 2 ? 0 : random.uniform(0, 100));
    std::fill(v.external.begin(), v.external.end(), Vec3::Zero());
    const SolverSettings settings = settings_of(i % 2 == 0 ? Precision::float64 : Precision::float32);
    const auto c = make_coefficients(v.network, i % 10 == 9 ? 0.01 : random.uniform(1e-4, 0.01), TimeStepPolicy::guard);
    const auto solver = NetworkSolver::make(v.network, c, v.rest, settings);
    const double energy = measure(v, settings, *solver).scale;
    v.put(*solver);
    for (int step = 0; step < 1000; ++step) solver->solve({});
    EXPECT_FALSE(solver->lost_node().has_value());
    for (std::uint32_t n = 0; n < v.rest.size(); ++n) {
      ASSERT_TRUE(is_finite(solver->position(n)));
      const double kinetic = 0.5 * v.network.masses[n] * squared_norm(solver->velocity(n));
      ASSERT_LE(kinetic, energy * (1 + (i % 2 == 0 ? 1e-9 : 1e-4)));
    }
  }
}

}  // namespace
}  // namespace crumble
