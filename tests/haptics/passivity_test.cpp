// Damping, energy and the controller against what paper and pencil say.
#include "crumble/haptics/passivity.hpp"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <cmath>

#include "crumble/base/memory.hpp"
#include "crumble/base/random.hpp"
#include "crumble/haptics/velocity_filter.hpp"
#include "crumble/haptics/virtual_coupling.hpp"

namespace crumble {
namespace {

// Of a mass on a held spring with a damper, without any other: it rings with growing swings below b = K T / 2 (for slow
// springs), and with shrinking ones above.
double growth(double stiffness, double damping, double mass, double tick, int delay) {
  double x = 1e-3, v = 0, late[4] = {0, 0, 0, 0};
  double first = 0, last = 0;
  for (int k = 0; k < 4000; ++k) {
    late[k % 4] = -stiffness * x - damping * v;
    const double force = late[(k + 4 - delay) % 4], a = force / mass;
    x += v * tick + 0.5 * a * tick * tick;
    v += a * tick;
    const double energy = 0.5 * mass * v * v + 0.5 * stiffness * x * x;
    if (k == 100) first = energy;
    last = energy;
  }
  return last / first;
}

TEST(Damping, IsWhatAHeldSpringNeeds) {
  for (const int delay : {0, 1, 2}) {
    const double stiffness = 200, tick = 1e-3, mass = 0.1;
    const double needed = needed_damping(stiffness * Mat3::Identity(), tick, 1, delay)(1, 1);
    EXPECT_NEAR(needed, stiffness * tick * (0.5 + delay), 1e-12);
    EXPECT_LT(growth(stiffness, 1.3 * needed, mass, tick, delay), 1) << delay;
    EXPECT_GT(growth(stiffness, 0.7 * needed, mass, tick, delay), 1) << delay;
  }
}

TEST(Damping, SizeIsNeverBelowTheGreatestEigenvalue) {
  Random random(5);
  for (int k = 0; k < 10000; ++k) {
    Mat3 a;
    for (int i = 0; i < 9; ++i) a(i / 3, i % 3) = random.uniform(-1, 1);
    const Mat3 m = a * a.transpose();
    const double greatest = Eigen::SelfAdjointEigenSolver<Mat3>(m).eigenvalues()[2];
    EXPECT_GE(size_of(m), greatest * (1 - 1e-12));
    EXPECT_LE(size_of(m), 1.74 * greatest);  // row sums: at most the root of 3
  }
  EXPECT_EQ(size_of(7 * Mat3::Identity()), 7);
}

TEST(Damping, LimitsAreTheDevices) {
  DeviceInfo info;
  info.mass = 0.075;
  EXPECT_NEAR(damping_limit({}, info, 1e-3), 5, 1e-12);
  EXPECT_NEAR(damping_limit({}, info, 0.01), 3.75, 1e-12);
  info.max_damping = 2;
  EXPECT_NEAR(damping_limit({}, info, 1e-3), 2, 1e-12);
  EXPECT_NEAR(damping_limit({.max_damping = 1.5}, info, 1e-3), 1.5, 1e-12);
}

TEST(Observer, CountsWhatTheHandDoesOnTheForce) {
  Random random(7);
  for (const int delay : {0, 1, 3}) {
    EnergyObserver observer({.delay = double(delay)});
    Vector<Vec3> forces, places;
    double energy = 0, least = 0;
    for (int k = 0; k < 500; ++k) {
      places.push_back({random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)});
      if (k > delay) energy -= forces[k - 1 - delay].dot(places[k] - places[k - 1]), least = std::min(least, energy);
      observer.moved(places[k]);
      ASSERT_NEAR(observer.energy().absorbed, energy, 1e-12 * 500);
      ASSERT_NEAR(observer.energy().least, least, 1e-12 * 500);
      forces.push_back({random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)});
      observer.sent({forces[k], Vec3::Zero(), Vec3::Zero()});
    }
  }
}

// A held spring without damping gives energy; the controller takes it back.
TEST(Controller, PaysTheDebt) {
  const auto swing = [](bool controlled) {
    EnergyObserver observer({.delay = 0});
    const double mass = 0.1, stiffness = 400, tick = 2e-3;
    double x = -2e-3, v = 0;
    for (int k = 0; k < 5000; ++k) {
      observer.moved({x, 0, 0});
      Vec3 force{x < 0 ? -stiffness * x : 0.0, 0, 0};
      Vec3 brake = Vec3::Zero();
      if (controlled) brake = observer.brake({v, 0, 0}, tick, 20);
      force += brake;
      observer.sent({force, Vec3::Zero(), brake});
      const double a = (force.x() - 0.5) / mass;  // a hand that presses with half a newton
      x += v * tick + 0.5 * a * tick * tick, v += a * tick;
    }
    return std::pair{observer.energy(), std::abs(v)};
  };
  const auto [free, free_speed] = swing(false);
  const auto [held, held_speed] = swing(true);
  EXPECT_LT(free.least, -1e-3);
  EXPECT_GT(held.least, 0.2 * free.least);
  EXPECT_GT(held.controlled, 0);
  EXPECT_LT(held_speed, 0.5 * free_speed);
}

TEST(Controller, DoesNothingWithoutDebt) {
  EnergyObserver observer({.delay = 0});
  observer.moved({0, 0, 0});
  observer.sent({{-1, 0, 0}, Vec3::Zero(), Vec3::Zero()});
  observer.moved({0.01, 0, 0});  // pushed against it: 10 mJ
  EXPECT_NEAR(observer.energy().absorbed, 0.01, 1e-15);
  EXPECT_EQ(observer.brake({1, 0, 0}, 1e-3, 5), Vec3(0, 0, 0));
  observer.sent({{-10, 0, 0}, Vec3::Zero(), Vec3::Zero()});
  observer.moved({0.008, 0, 0});
  const Vec3 brake = observer.brake({-1, 0, 0}, 1e-3, 1000);
  EXPECT_NEAR(brake.x(), 0.01 / 1e-3, 1e-9);  // 10 mJ in a millisecond at 1 m/s
  EXPECT_NEAR(observer.brake({-1, 0, 0}, 1e-3, 2).x(), 2, 1e-12);
  EXPECT_LT(norm(observer.brake({1e-9, 0, 0}, 1e-3, 1000)), 1e-3);  // hardly moves: no wild force
}

TEST(Controller, OldCreditIsForgotten) {
  EnergyObserver observer({.delay = 0, .energy_credit = 0.005});
  observer.moved({0, 0, 0});
  observer.sent({{-1, 0, 0}, Vec3::Zero(), Vec3::Zero()});
  observer.moved({1, 0, 0});
  EXPECT_NEAR(observer.energy().absorbed, 1, 1e-12);
  EXPECT_NEAR(observer.energy().credit, 0.005, 1e-15);
}

TEST(VelocityFilter, IsExactForSteadyMotionWithoutSteps) {
  VelocityFilter filter(0);
  Vec3 v;
  for (int k = 0; k < 20; ++k) v = filter.take({1e-3 * k, 0, -2e-3 * k}, 1e-3);
  EXPECT_NEAR(v.x(), 1, 1e-9);
  EXPECT_NEAR(v.z(), -2, 1e-9);
}

// Against the raw difference of positions in steps: quieter while slow, as quick when fast.
TEST(VelocityFilter, SeesThroughTheSteps) {
  constexpr double kStep = 5.5e-5, kTick = 1e-3;
  VelocityFilter filter(kStep);
  double raw_error = 0, error = 0, before = 0;
  for (int k = 0; k < 4000; ++k) {
    const double true_x = 0.01 * std::sin(2 * kTick * k), true_v = 0.02 * std::cos(2 * kTick * k);
    const double x = std::round(true_x / kStep) * kStep;
    const double v = filter.take({x, 0, 0}, kTick).x();
    raw_error += std::pow((x - before) / kTick - true_v, 2), error += std::pow(v - true_v, 2);
    before = x;
  }
  EXPECT_LT(std::sqrt(error), 0.4 * std::sqrt(raw_error));
  VelocityFilter fast(kStep);
  for (int k = 0; k < 30; ++k) fast.take({0, 0, 0}, kTick);
  fast.take({1e-3, 0, 0}, kTick);
  EXPECT_NEAR(fast.take({2e-3, 0, 0}, kTick).x(), 1, 0.06);
}

TEST(VirtualCoupling, FindsTheBalance) {
  VirtualCoupling coupling(500);
  coupling.place(Vec3::Zero());
  Mat3 body = Mat3::Zero();
  body.diagonal() = Vec3(1000, 3000, 0);
  body(0, 1) = body(1, 0) = 200;
  const Vec3 device{0.001, -0.004, 0.002}, rest{0.0005, 0, 0};
  Vec3 x = Vec3::Zero();
  for (int k = 0; k < 5; ++k) x = coupling.move(device, -body * (x - rest), body, 1);
  const Vec3 pull = 500 * (device - x), push = -body * (x - rest);
  EXPECT_LT(norm(pull + push), 1e-12);
  EXPECT_LT(norm(coupling.force_at(device) + pull), 1e-12);
}

TEST(VirtualCoupling, StiffnessFollowsFromTheDevice) {
  DeviceInfo info;
  EXPECT_NEAR(safe_stiffness(info, {.delay = 0}, 1e-3), kMostStiffness, 1e-9);
  info.max_stiffness = 400;
  EXPECT_NEAR(safe_stiffness(info, {}, 1e-3), 320, 1e-9);
  info.max_stiffness = 0, info.max_damping = 0.6;
  EXPECT_NEAR(safe_stiffness(info, {}, 1e-3), 0.6 / 1.5e-3, 1e-9);
  info.max_damping = 100, info.mass = 0.075;
  EXPECT_NEAR(safe_stiffness(info, {}, 2.9e-3), 0.05 * 0.075 / std::pow(4.35e-3, 2), 1e-9);
}

}  // namespace
}  // namespace crumble
