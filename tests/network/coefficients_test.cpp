#include "crumble/network/coefficients.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "crumble/base/error.hpp"
#include "crumble/base/random.hpp"
#include "crumble/network/stability.hpp"
#include "crumble/tetmesh/lattice_box.hpp"
#include "network/two_nodes.hpp"

namespace crumble {
namespace {

// long double libm is the oracle; below 1e-3 the series of the definition
TEST(Coefficients, PhiFunctionsKeepTheirDigitsAtEveryGamma) {
  Random random(1);
  for (int i = 0; i < 100000; ++i) {
    const long double g = std::pow(10.0, random.uniform(-12, 3));
    const auto gamma = static_cast<double>(g);
    const long double exact1 = -std::expm1(-static_cast<long double>(gamma)) / gamma;
    const long double exact2 = gamma < 1e-3 ? 0.5L - gamma / 6.0L + gamma * static_cast<long double>(gamma) / 24 -
                                                  std::pow(static_cast<long double>(gamma), 3) / 120 +
                                                  std::pow(static_cast<long double>(gamma), 4) / 720
                                            : (1 - exact1) / gamma;
    ASSERT_NEAR(static_cast<double>(phi1(gamma) / exact1), 1, 1e-13) << gamma;
    ASSERT_NEAR(static_cast<double>(phi2(gamma) / exact2), 1, 1e-13) << gamma;
  }
  EXPECT_EQ(phi1(0), 1);
  EXPECT_EQ(phi2(0), 0.5);
}

// m v' + c v = f has a closed form; the exponential step follows it exactly for a constant force.
TEST(Coefficients, OneNodeUnderConstantForceIsExact) {
  for (const double drag : {0.0, 1e-6, 0.01, 2.2, 1e4}) {
    const double mass = 4.5e-5, tau = 1e-3, force = 0.7, v0 = -0.3;
    TwoNodes pair(mass, drag, 1, 1);
    if (drag == 0) pair.network.stiffness_sums = {0, 0};  // else the guard would add drag for the (cut) spring
    const auto solver = pair.solver(tau, drag > 0 ? TimeStepPolicy::unchecked : TimeStepPolicy::guard);
    VecArray external(2);
    external.x[1] = force;
    solver->set_external(external);
    solver->set_share(0, 0);
    solver->place(1, Vec3::UnitX(), v0 * Vec3::UnitX());
    const int steps = 50;
    for (int i = 0; i < steps; ++i) solver->solve({});
    const long double t = steps * static_cast<long double>(tau), g = drag / static_cast<long double>(mass);
    const long double v = drag == 0 ? v0 + force / static_cast<long double>(mass) * t
                                    : force / static_cast<long double>(drag) +
                                          (v0 - force / static_cast<long double>(drag)) * std::exp(-g * t);
    const long double x = drag == 0 ? 1 + v0 * t + force / static_cast<long double>(mass) * t * t / 2
                                    : 1 + force / static_cast<long double>(drag) * t -
                                          (v0 - force / static_cast<long double>(drag)) * std::expm1(-g * t) / g;
    EXPECT_NEAR(solver->velocity(1).x(), static_cast<double>(v), 1e-12 * std::abs(static_cast<double>(v))) << drag;
    EXPECT_NEAR(solver->position(1).x(), static_cast<double>(x), 1e-12 * std::abs(static_cast<double>(x))) << drag;
  }
}

// On one axis the spring is linear and a step is a 2 x 2 matrix: the n-th power by its eigenvalues is the closed form.
TEST(Coefficients, TwoNodesFollowTheMatrixPower) {
  const double mass = 4.5e-5, drag = 2.2, stiffness = 30, rest = 0.0044, tau = 1e-3;
  TwoNodes pair(mass, drag, stiffness, rest);
  const auto solver = pair.solver(tau, TimeStepPolicy::error);
  solver->place(1, {rest + 0.001, 0, 0}, {0.02, 0, 0});
  const int steps = 40;
  for (int i = 0; i < steps; ++i) solver->solve({});

  using Long = long double;
  const Long g = Long{drag} * tau / mass, p1 = -std::expm1(-g) / g, p2 = (1 - p1) / g;
  const Long a = 1 - Long{stiffness} * tau * tau / mass * p2, b = tau * p1;
  const Long d = -Long{stiffness} * tau / mass * p1, e = std::exp(-g);
  const Long half = (a + e) / 2, root = std::sqrt(half * half - (a * e - b * d));
  const Long l1 = half + root, l2 = half - root;
  const Long q1 = std::pow(l1, Long{steps}), q2 = std::pow(l2, Long{steps});
  // M^n = (q1 (M - l2) - q2 (M - l1)) / (l1 - l2)
  const auto power = [&](Long m, Long diagonal) {
    return (q1 * (m - diagonal * l2) - q2 * (m - diagonal * l1)) / (l1 - l2);
  };
  const Long u0 = Long{rest} + 0.001L - rest, v0 = 0.02L;
  EXPECT_NEAR(solver->position(1).x() - rest, static_cast<double>(power(a, 1) * u0 + power(b, 0) * v0), 1e-12 * rest);
  EXPECT_NEAR(solver->velocity(1).x(), static_cast<double>(power(d, 0) * u0 + power(e, 1) * v0), 1e-12 * 0.02);
}

bool stays_bounded(double mass, double drag, double tau, double stiffness) {
  const TwoNodes pair(mass, drag, stiffness, 1);
  const auto solver = pair.solver(tau, TimeStepPolicy::unchecked);
  solver->place(1, {1 + 1e-9, 0, 0}, Vec3::Zero());
  for (int i = 0; i < 20000; ++i) {
    solver->solve({});
    if (std::abs(solver->position(1).x() - 1) > 1e-7) return false;
  }
  return true;
}

TEST(Stability, FormulaAgreesWithBisectedSimulations) {
  for (const double gamma : {0.05, 0.3, 1.0, 3.0, 10.0, 50.0, 300.0}) {
    const double mass = 4.5e-5, tau = 1e-3, drag = gamma * mass / tau;
    double low = 0, high = 100 * drag / tau;
    for (int i = 0; i < 30; ++i) {
      const double middle = (low + high) / 2;
      (stays_bounded(mass, drag, tau, middle) ? low : high) = middle;
    }
    EXPECT_NEAR(low * tau / drag / stability_limit(gamma), 1, 0.01) << "gamma " << gamma;
  }
}

TEST(Stability, GreatestEigenvalueOfOneSpringBetweenFreeNodes) {
  TwoNodes pair(1, 1, 30, 1);
  EXPECT_NEAR(largest_eigenvalue(pair.network, pair.rest), 60, 1e-6);
}

TEST(Coefficients, PoliciesAnswerALongTimeStep) {
  const TetMesh mesh = make_lattice_box({0.03, 0.03, 0.03}, 0.01);
  Material soft;  // low damping, so that 1 ms is too long
  soft.damping_ratio = 0.5;
  const SpringNetwork network = make_network(mesh, soft, MassRule::lumped, {});
  const StepCoefficients guarded = make_coefficients(network, 1e-3, TimeStepPolicy::guard);
  EXPECT_GT(guarded.guarded_nodes, 0u);
  EXPECT_LT(guarded.certified_time_step, 1e-3);
  const StepCoefficients divided = make_coefficients(network, 1e-3, TimeStepPolicy::substep);
  EXPECT_EQ(divided.substeps, std::ceil(1e-3 / guarded.certified_time_step));
  EXPECT_EQ(divided.substep, 1e-3 / divided.substeps);
  EXPECT_THROW(make_coefficients(network, 1e-3, TimeStepPolicy::error), Error);
  EXPECT_EQ(make_coefficients(network, 1e-3, TimeStepPolicy::unchecked).guarded_nodes, 0u);

  // where the rule holds the guard changes no bit
  const double certified = guarded.certified_time_step;
  EXPECT_EQ(make_coefficients(network, 0.99 * certified, TimeStepPolicy::guard).force_gain,
            make_coefficients(network, 0.99 * certified, TimeStepPolicy::unchecked).force_gain);
}

TEST(Coefficients, RefusesBadInputByName) {
  const TetMesh mesh = make_lattice_box({0.03, 0.03, 0.03}, 0.01);
  const auto code_of = [&](
                           double tau, TimeStepPolicy policy,
                           const std::function<void(Material&)>& change = [](Material&) {}) {
    try {
      Material material;
      change(material);
      make_coefficients(make_network(mesh, material, MassRule::equal, {}), tau, policy);
    } catch (const Error& error) {
      return error.code();
    }
    return Code{0};
  };
  using P = TimeStepPolicy;
  EXPECT_EQ(code_of(1e-3, P::guard), Code{0});
  EXPECT_EQ(code_of(0, P::guard), Code::out_of_range);
  EXPECT_EQ(code_of(std::nan(""), P::guard), Code::invalid_value);
  EXPECT_EQ(code_of(0.02, P::guard), Code::dt_too_large);
  EXPECT_EQ(code_of(1e-3, P::guard, [](Material& m) { m.stiffness = 0; }), Code::out_of_range);
  EXPECT_EQ(code_of(1e-3, P::guard, [](Material& m) { m.mass = -1; }), Code::out_of_range);
  EXPECT_EQ(code_of(1e-3, P::guard, [](Material& m) { m.length_limit = 1; }), Code::out_of_range);
  EXPECT_EQ(code_of(1e-3, P::guard, [](Material& m) { m.damping_ratio = 0; }), Code{0});
  EXPECT_EQ(code_of(1e-3, P::substep, [](Material& m) { m.damping_ratio = 0; }), Code::dt_too_large);
  EXPECT_EQ(code_of(1e-3, P::unchecked, [](Material& m) { m.damping_ratio = 0; }), Code::out_of_range);
  EXPECT_EQ(code_of(1e-3, P::guard, [](Material& m) { m.damping_ratio = std::nan(""); }), Code::invalid_value);
}

}  // namespace
}  // namespace crumble
