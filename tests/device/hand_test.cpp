#include "crumble/device/hand.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <utility>

#include "crumble/base/memory.hpp"
#include "device/samples.hpp"

namespace crumble {
namespace {

constexpr double kTick = 1e-3;
const Vec3 start = {0.01, 0.05, -0.02};

// At rest at start, with no wish to leave it.
HandOptions quiet() {
  return {.start = {start, Quat::Identity()}, .points = {{.time = 0}}};
}

DeviceSample next(Device& device) {
  DeviceSample sample;
  static_cast<void>(device.read(sample));
  return sample;
}

// m y'' + b y' + k y = 0 from y(0) and y'(0), less than critically damped.
struct Decay {
  Decay(const HandOptions& o, double y, double rate)
      : slowing(o.damping / (2 * o.mass)),
        omega(std::sqrt(o.stiffness / o.mass - slowing * slowing)),
        a(y),
        b((rate + slowing * y) / omega) {}
  double y(double t) const { return std::exp(-slowing * t) * (a * std::cos(omega * t) + b * std::sin(omega * t)); }
  double rate(double t) const {
    const double turned = b * std::cos(omega * t) - a * std::sin(omega * t);
    return std::exp(-slowing * t) * omega * turned - slowing * y(t);
  }
  double slowing, omega, a, b;
};

// A wish that jumps at time 0, and a force that does: the same motion, toward either rest, at either tick.
TEST(Hand, SwingsAsADampedOscillator) {
  const Vec3 along = Vec3(3, -4, 12) / 13;
  for (const double tick : {1e-3, 1e-4}) {
    HandOptions options = quiet();
    SimulatedHand pushed(options, tick);
    options.points = {{.time = 0, .move = 0.01 * along}};
    SimulatedHand wishing(options, tick);
    const Decay decay(options, -0.01, 0);
    const double bound = 15 * tick / 64;  // of the first order, as the substeps are; 22 rad/s
    for (int k = 0; k * tick <= 2; ++k) {
      const double t = k * tick;
      const DeviceSample felt = next(pushed), wished = next(wishing);
      if (k == 0) pushed.write(options.stiffness * 0.01 * along, Vec3::Zero());  // and never again
      for (const DeviceSample& sample : {felt, wished}) {
        ASSERT_NEAR(norm(sample.pose.position - start - (0.01 + decay.y(t)) * along), 0, 0.01 * bound) << k;
        ASSERT_NEAR(norm(sample.linear_velocity - decay.rate(t) * along), 0, 0.01 * 25 * bound) << k;
      }
    }
  }
}

TEST(Hand, GivesWayToASteadyForceByItsStiffness) {
  const auto rest = [](const Vec3& force) {
    SimulatedHand hand(quiet(), kTick);
    for (int k = 0; k < 20'000; ++k) {
      next(hand);
      hand.write(force, {1, 2, 3});
    }
    return Vec3((hand.position() - start) * 50);
  };
  EXPECT_NEAR(norm(rest({0.3, -0.4, 1.2}) - Vec3(0.3, -0.4, 1.2)), 0, 1e-13);
  for (const double size : {4.0, 100.0, 1e200, 1e308})
    EXPECT_NEAR(norm(rest(size * Vec3(0.6, 0, -0.8)) - 3.3 * Vec3(0.6, 0, -0.8)), 0, 1e-12) << size;
  EXPECT_NEAR(norm(rest({2, 2, 2}) - Vec3(3.3, 3.3, 3.3) / std::sqrt(3.0)), 0, 1e-12);  // no coordinate is too large
}

TEST(Hand, TakesAForceThatIsNoneForZero) {
  const double nan = std::numeric_limits<double>::quiet_NaN(), inf = std::numeric_limits<double>::infinity();
  HandOptions options = quiet();
  options.points = {{.time = 0.2, .move = {0.01, 0.02, 0.03}}};
  SimulatedHand told(options, kTick), free(options, kTick);
  for (int k = 0; k < 300; ++k) {
    ASSERT_EQ(bits(next(told)), bits(next(free))) << k;
    ASSERT_EQ(told.energy_given(), free.energy_given()) << k;
    const Vec3 force = k % 7 ? Vec3(0, 0, 0) : Vec3(0.1, 0, 0);
    told.write(k % 7 == 0 ? force : k % 2 == 0 ? Vec3(0.1, nan, 0.1) : Vec3(0.1, 0.1, -inf), Vec3::Zero());
    free.write(force, Vec3::Zero());
  }
  EXPECT_GT(norm(free.velocity()), 1e-3);
}

// While the wish is a polynomial of time, so is one motion of the hand; the other is the decay from there.
TEST(Hand, FollowsTheMoveOfLeastJerk) {
  constexpr double kLength = 0.4;
  const Vec3 move = {0.03, -0.02, 0.01};
  HandOptions options = quiet();
  options.stiffness = 200, options.damping = 2;
  options.points = {{.time = kLength, .move = move}, {.time = 3, .move = move}, {.time = 3.2, .move = -move}};
  std::array<double, 8> wish = {0, 0, 0, 10, -15, 6}, moved = {};  // of t / kLength
  for (std::size_t i = 6; i-- > 0;) {
    const double j = static_cast<double>(i);
    moved[i] = wish[i] - options.damping / kLength * (j + 1) * moved[i + 1] / options.stiffness -
               options.mass / (kLength * kLength) * (j + 2) * (j + 1) * moved[i + 2] / options.stiffness;
  }
  const Decay decay(options, -moved[0], -moved[1] / kLength);
  SimulatedHand hand(options, kTick);
  for (int k = 0; k <= 6000; ++k) {
    const Vec3 at = next(hand).pose.position - start;
    if (k <= 400) {
      double share = decay.y(k * kTick), power = 1;
      for (const double coefficient : moved) share += coefficient * power, power *= k * kTick / kLength;
      ASSERT_NEAR(norm(at - share * move), 0, 2e-4 * norm(move)) << k;
    }
    if (k == 3000) {
      EXPECT_NEAR(norm(at - move), 0, 1e-12);  // and held there from 0.4 s on
    }
  }
  EXPECT_NEAR(norm(hand.position() - (start - move)), 0, 1e-12);
}

// A hand so stiff that it is where it wants to be.
TEST(Hand, WantsTheCurveOfLeastJerk) {
  HandOptions options = quiet();
  options.mass = 1e-3, options.device_mass = 1e-3, options.stiffness = 1e6, options.damping = 40;
  options.points = {{.time = 1, .move = {0.01, 0, 0}}, {.time = 1.5, .move = {0.01, 0.02, 0}}};
  SimulatedHand hand(options, kTick);
  const auto share = [](double t) {
    const double s = std::clamp(t, 0.0, 1.0);
    return 10 * s * s * s - 15 * s * s * s * s + 6 * s * s * s * s * s;
  };
  for (int k = 0; k <= 2000; ++k) {
    const Vec3 at = next(hand).pose.position - start;
    ASSERT_NEAR(at.x(), 0.01 * share(k * kTick), 2e-6) << k;
    ASSERT_NEAR(at.y(), 0.02 * share((k * kTick - 1) / 0.5), 4e-6) << k;
  }
}

struct Ledger {
  double kinetic, spring, damper, friction, given, passed;  // J; `passed`: what went to and fro, without sign
};

// What a random force does to a hand that wants to stay; losses by the corrected trapezoidal rule over each tick.
// In semi-implicit substeps the position is half a substep ahead of the velocity: here the energies are taken without.
Ledger ledger(const HandOptions& options, std::uint64_t seed) {
  Random random(seed);
  SimulatedHand hand(options, kTick);
  const double ahead = kTick / 128;
  Ledger out = {};
  next(hand);
  for (int k = 0; k < 3000; ++k) {
    const Vec3 force = random_vec(random, 1.5), v = hand.velocity(), x = hand.position();
    hand.write(force, Vec3::Zero());
    next(hand);
    const auto power_change = [&](const Vec3& at, const Vec3& speed) {
      const Vec3 pull = options.stiffness * (start - at) - options.damping * speed + force;
      return 2 * options.damping * dot(speed, pull) / options.mass;
    };
    const Vec3 w = hand.velocity();
    out.damper += kTick / 2 * options.damping * (squared_norm(v) + squared_norm(w)) +
                  kTick * kTick / 12 * (power_change(x, v) - power_change(hand.position(), w));
    out.friction += kTick / 2 * options.friction * (norm(v) + norm(w));
    out.passed += std::abs(dot(force, hand.position() - x));
    out.given += ahead * dot(force, w - v);
  }
  out.kinetic = options.mass / 2 * squared_norm(hand.velocity());
  out.spring = options.stiffness / 2 * squared_norm(hand.position() - ahead * hand.velocity() - start);
  out.given += hand.energy_given();
  return out;
}

TEST(Hand, EnergyBalances) {
  for (const std::uint64_t seed : {1u, 2u, 3u, 4u}) {
    const Ledger free = ledger(quiet(), seed);
    const double sum = free.kinetic + free.spring + free.damper + free.given;
    EXPECT_GT(free.damper, 0.05 * free.passed);
    EXPECT_NEAR(sum, 0, 2e-4 * free.passed);
    HandOptions options = quiet();
    options.friction = 0.2;
    const Ledger rubbed = ledger(options, seed);
    EXPECT_GT(rubbed.friction, 0.1 * rubbed.passed);
    EXPECT_NEAR(rubbed.kinetic + rubbed.spring + rubbed.damper + rubbed.given, -rubbed.friction,
                0.01 * rubbed.friction);
  }
}

TEST(Hand, TellsTheWorkOfTheForceToTheLastBit) {
  Random random(5);
  HandOptions options = quiet();
  options.points = {{.time = 0.5, .move = {0, -0.02, 0}}};
  SimulatedHand hand(options, kTick);
  next(hand);
  double given = 0;
  for (int k = 0; k < 1000; ++k) {
    const Vec3 force = random_vec(random, 1.5), before = hand.position();
    hand.write(force, Vec3::Zero());
    next(hand);
    given -= dot(force, hand.position() - before);
    ASSERT_EQ(hand.energy_given(), given) << k;
  }
  EXPECT_NE(given, 0);
}

// A free mass of 0.1 kg tells when a force acted, and how long.
TEST(Hand, FeelsAForceAsManyTicksLaterAsItsDelay) {
  for (const std::uint32_t delay : {0u, 1u, 3u, HandOptions::kMaxDelay}) {
    HandOptions options = quiet();
    options.stiffness = 0, options.damping = 0, options.delay = delay;
    SimulatedHand pulse(options, kTick), lasting(options, kTick);
    for (std::uint32_t k = 0; k < 300; ++k) {
      next(pulse), next(lasting);
      const std::uint32_t first = 10 + delay;  // tick in which the force acts; the velocity is seen when it has passed
      ASSERT_NEAR(pulse.velocity().y(), k > first ? 2 * kTick / 0.1 : 0, 1e-14) << k;
      ASSERT_NEAR(lasting.velocity().y(), k > first ? (k - first) * 2 * kTick / 0.1 : 0, 1e-12) << k;
      pulse.write({0, k == 10 ? 2.0 : 0, 0}, Vec3::Zero());
      if (k == 10) {
        lasting.write({0, -1, 0}, Vec3::Zero());  // the last word counts
        lasting.write({0, 2, 0}, Vec3::Zero());
      }
    }
  }
}

TEST(Hand, DelayShiftsAMotionAndNothingElse) {
  for (const std::uint32_t delay : {1u, 3u, 17u, HandOptions::kMaxDelay}) {
    Random random(delay);
    HandOptions options = quiet();
    options.friction = 0.05;
    SimulatedHand prompt(options, kTick);
    options.delay = delay;
    SimulatedHand late(options, kTick);
    Vector<Vec3> seen;
    for (std::uint32_t k = 0; k < 500; ++k) {
      seen.push_back(next(prompt).pose.position);
      const Vec3 told = next(late).pose.position;
      ASSERT_EQ(told, seen[k < delay ? 0 : k - delay]) << k;
      if (random.below(3) == 0) continue;  // no write in this tick
      const Vec3 force = random_vec(random, 2);
      prompt.write(force, Vec3::Zero()), late.write(force, Vec3::Zero());
    }
    EXPECT_GT(norm(seen.back() - seen.front()), 1e-4);
  }
}

// A free mass on a spring K that is felt tick by tick. The motion is linear, so two of them span an area of place and
// velocity, which each tick multiplies by the same factor: 1 for a spring that is there all the time, and for a force
// that is held for T it is 1 + K T^2 / 2 m. In semi-implicit substeps the place is half of one ahead: 1/64 less.
TEST(Hand, IsFedByASpringThatIsHeldForATick) {
  HandOptions options = quiet();
  options.stiffness = 0, options.damping = 0, options.max_force = 1e3;
  for (const double spring : {50.0, 1000.0, 4000.0}) {
    SimulatedHand placed(options, kTick), pushed(options, kTick);
    const auto stretch = [&](const SimulatedHand& hand, double rest) { return hand.position().y() - start.y() - rest; };
    const auto area = [&] {
      return stretch(placed, 1e-3) * pushed.velocity().y() - stretch(pushed, 0) * placed.velocity().y();
    };
    next(placed), next(pushed);
    placed.write({0, 1e-3 * spring, 0}, Vec3::Zero());
    pushed.write({0, 1, 0}, Vec3::Zero());
    double last = 0;
    for (int k = 1; k <= 30; ++k) {
      next(placed), next(pushed);
      const double now = area();
      if (k > 1) {
        ASSERT_NEAR(now / last, 1 + spring * kTick * kTick / (2 * options.mass) * (1 - 1.0 / 64), 1e-11) << k;
      }
      last = now;
      placed.write({0, -spring * stretch(placed, 1e-3), 0}, Vec3::Zero());
      pushed.write({0, -spring * stretch(pushed, 0), 0}, Vec3::Zero());
    }
  }
}

TEST(Hand, GivesTheSameBitsInTwoRuns) {
  const auto run = [] {
    Random random(13);
    HandOptions options = quiet();
    options.start.orientation = axis_angle({0.6, 0, 0.8}, 1);
    options.points = {{.time = 0.1, .move = {0.01, 0.02, 0.03}}, {.time = 0.7, .move = {0, 0, -0.01}}};
    options.friction = 0.05, options.delay = 2;
    SimulatedHand hand(options, kTick);
    Vector<std::array<std::uint64_t, 16>> out;
    for (int k = 0; k < 1000; ++k) {
      out.push_back(bits(next(hand)));
      hand.write(random_vec(random, 2), Vec3::Zero());
    }
    return std::pair(out, std::bit_cast<std::uint64_t>(hand.energy_given()));
  };
  EXPECT_EQ(run(), run());
}

TEST(Hand, TellsWholeStepsOfItsEncoders) {
  Random random(7);
  HandOptions options = quiet();
  options.start.orientation = axis_angle({0, 0, 1}, 1);
  options.points = {{.time = 0.5, .move = {0.02, -0.02, 0.03}}};
  SimulatedHand exact(options, kTick);
  options.encoder_step = 5.5e-5;
  SimulatedHand coarse(options, kTick);
  double worst = 0;
  for (int k = 0; k < 1000; ++k) {
    const DeviceSample a = next(exact), b = next(coarse);
    ASSERT_EQ(exact.position(), coarse.position()) << k;  // it moves alike
    EXPECT_EQ(a.pose.position, exact.position());
    EXPECT_EQ(a.linear_velocity, exact.velocity());
    EXPECT_EQ(b.linear_velocity, Vec3(0, 0, 0));
    EXPECT_NEAR(std::abs(b.pose.orientation.dot(options.start.orientation)), 1, 1e-15);
    for (int axis = 0; axis < 3; ++axis) {
      const double steps = b.pose.position[axis] / 5.5e-5,
                   off = std::abs(b.pose.position[axis] - a.pose.position[axis]);
      EXPECT_NEAR(steps, std::nearbyint(steps), 1e-9) << k;
      EXPECT_LE(off, 5.5e-5 / 2 + 1e-15) << k;
      worst = std::max(worst, off);
    }
    const Vec3 force = random_vec(random, 1);
    exact.write(force, Vec3::Zero()), coarse.write(force, Vec3::Zero());
  }
  EXPECT_GT(worst, 2.7e-5);
}

TEST(Hand, StandsStillBelowItsFriction) {
  HandOptions options = quiet();
  options.friction = 0.1;
  options.points = {{.time = 0, .move = {0.0011, 0, 0}}};  // pulls by 0.055 N
  SimulatedHand hand(options, kTick);
  const Vec3 across = {0, 0.083, 0};  // with it 0.0996 N, less than f as a vector
  for (int k = 0; k < 1000; ++k) {
    ASSERT_EQ(next(hand).pose.position, start);
    hand.write(across, Vec3::Zero());
  }
  hand.write({0, 0.086, 0}, Vec3::Zero());  // 0.1021 N
  next(hand);
  EXPECT_GT(hand.velocity().x(), 0);
  EXPECT_GT(hand.velocity().y(), 0);
}

// 1 N for 0.1 s on a free mass of 0.1 kg, then none: up to 0.8 m/s by (F - f) / m, then down by f / m until it stands.
TEST(Hand, FrictionStopsItAndTurnsNothingRound) {
  const Vec3 along = Vec3(3, -4, 12) / 13;
  HandOptions options = quiet();
  options.stiffness = 0, options.damping = 0, options.friction = 0.2;
  SimulatedHand hand(options, kTick);
  for (int k = 0; k <= 1000; ++k) {
    const double time = k * kTick, end = 0.1 + 0.8 / 2;
    const Vec3 v = next(hand).linear_velocity;
    ASSERT_NEAR(norm(v - std::max(0.0, time < 0.1 ? 8 * time : 0.8 - 2 * (time - 0.1)) * along), 0, 1e-12) << k;
    if (time > end + kTick) {
      ASSERT_EQ(v, Vec3(0, 0, 0));
    }
    hand.write(k < 100 ? along : Vec3(0, 0, 0), Vec3::Zero());
  }
  EXPECT_NEAR(dot(hand.position() - start, along), 0.04 + 0.8 * 0.8 / (2 * 2), 0.8 * kTick / 64);
}

TEST(Hand, IsFinishedAfterItsLastPointAndStaysAlive) {
  HandOptions options = quiet();
  options.points = {{.time = 0.071, .move = {0, 0, 0}}};  // 71 * 1e-3 is above it, by a rounding
  SimulatedHand hand(options, kTick);
  DeviceSample sample;
  for (std::uint64_t k = 0; k <= 71; ++k) {
    ASSERT_EQ(hand.read(sample), ReadStatus::ok) << k;
    EXPECT_EQ(sample.flags, 0u);
  }
  for (std::uint64_t k = 72; k < 20'000; ++k) {
    ASSERT_EQ(hand.read(sample), ReadStatus::finished);
    EXPECT_EQ(sample.flags, sample_flag::kFinished);
    EXPECT_EQ(sample.sequence, k);
    EXPECT_EQ(sample.time, static_cast<double>(k) * kTick);
    hand.write({0, 1, 0}, Vec3::Zero());
  }
  EXPECT_NEAR(sample.pose.position.y(), start.y() + 1.0 / 50, 1e-12);
}

}  // namespace
}  // namespace crumble
