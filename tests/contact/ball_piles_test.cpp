// How crumbs move that touch by balls: they lose energy, come to rest, stick and slide.
#include <gtest/gtest.h>

#include "contact/crumb_rig.hpp"
#include "crumble/base/random.hpp"

namespace crumble {
namespace {

Vec3 random_vector(Random& random, double size) {
  return {random.uniform(-size, size), random.uniform(-size, size), random.uniform(-size, size)};
}

// Crumbs of 1 to 8 nodes in any shape, thrown at each other.
TEST(BallPiles, CollisionsTakeEnergyOut) {
  std::size_t hits = 0;
  double most = 0, kept = 0;
  for (const double tau : {5e-4, 1e-3, 2e-3, 2.9e-3}) {
    for (std::uint64_t seed = 0; seed < 60; ++seed) {
      Random random(seed);
      RigSetup setup{.positions = {}, .labels = {}, .tau = tau};
      for (std::uint32_t crumb = 0; crumb < 2; ++crumb) {
        Vec3 at(crumb == 0 ? -0.02 : 0.02, 0, 0);
        for (std::uint64_t n = 1 + random.below(8); n > 0; --n) {
          setup.positions.push_back(at), setup.labels.push_back(crumb);
          at += 0.0044 * normalized(random_vector(random, 1));
        }
      }
      CrumbRig rig(setup);
      rig.gravity.setZero(), rig.floor = false;
      const double speed = random.uniform(0.02, 0.4);
      for (Crumb& c : rig.crumbs) c.velocity = Vec3(c.center.x() < 0 ? speed : -speed, 0, 0);
      rig.gravity.setZero();
      rig.sync();
      const double before = rig.kinetic_energy();
      bool touched = false;
      for (int step = 0; step < static_cast<int>(0.08 / speed / tau); ++step) {
        rig.step();
        touched = touched || rig.balls->contact_count() > 0;
        most = std::max(most, rig.kinetic_energy() / before);
      }
      hits += touched;
      if (!touched) continue;
      EXPECT_LT(rig.kinetic_energy(), 0.999 * before) << "tau " << tau << " seed " << seed;
      kept += rig.kinetic_energy() / before;
    }
  }
  EXPECT_GT(hits, 100u);
  EXPECT_LE(most, 1 + 1e-6);
  EXPECT_LT(kept / static_cast<double>(hits), 0.7);
}

RigSetup rain_of_crumbs(std::uint32_t nodes_each, double tau) {
  Random random(3);
  RigSetup setup{.positions = {}, .labels = {}, .tau = tau};
  const Vec3 corners[4]{{0, 0, 0}, {0.0044, 0, 0}, {0, 0.0044, 0}, {0, 0, 0.0044}};
  for (std::uint32_t crumb = 0; crumb < 48; ++crumb) {
    const Vec3 at(crumb % 4 * 0.01, 0.006 + crumb / 16 * 0.01, crumb / 4 % 4 * 0.01);
    for (std::uint32_t i = 0; i < nodes_each; ++i) {
      setup.positions.push_back(at + corners[i] + random_vector(random, i == 0 ? 1e-3 : 1e-6));
      setup.labels.push_back(crumb);
    }
  }
  return setup;
}

double height_of_all(const CrumbRig& rig) {
  double sum = 0;
  for (const Crumb& c : rig.crumbs) sum += c.center.y();
  return sum / static_cast<double>(rig.crumbs.size());
}

// They fall into a heap, and there they lie: 1e-8 J would lift one node by 0.02 mm.
TEST(BallPiles, PilesComeToRest) {
  for (const double tau : {1e-3, 2.9e-3}) {
    for (std::uint32_t nodes_each = 1; nodes_each <= 4; ++nodes_each) {
      CrumbRig rig(rain_of_crumbs(nodes_each, tau));
      for (double time = 0; time < 4; time += tau) rig.step();
      const VecArray before = rig.positions;
      EXPECT_LT(rig.kinetic_energy(), 1e-8) << nodes_each << " nodes each, tau " << tau;
      for (double time = 0; time < 1; time += tau) rig.step();
      double farthest = 0;
      for (std::size_t i = 0; i < before.size(); ++i) farthest = std::max(farthest, norm(rig.positions[i] - before[i]));
      EXPECT_LT(farthest, 2e-4) << "creeps: " << nodes_each << " nodes each, tau " << tau;
      EXPECT_LT(rig.kinetic_energy(), 1e-8);
      EXPECT_GT(rig.balls->contact_count(), 10u);
    }
  }
}

// A pyramid of balls on a square of balls that stand still: with friction it stands, without it runs.
TEST(BallPiles, FrictionHoldsASlope) {
  const auto height_after = [](double friction) {
    RigSetup setup{.positions = {}, .labels = {}, .friction = {friction, friction}};
    std::uint32_t label = 0;
    for (int layer = 0; layer < 5; ++layer) {
      for (int i = 0; i < 5 - layer; ++i) {
        for (int k = 0; k < 5 - layer; ++k) {
          const double shift = 0.0022 * layer;
          setup.positions.push_back({0.0044 * i + shift, 0.0044 / std::sqrt(2.0) * layer, 0.0044 * k + shift});
          setup.labels.push_back(label);
          if (layer == 0) setup.fixed_crumbs.push_back(label);
          ++label;
        }
      }
    }
    for (Vec3& at : setup.positions) at *= 1.0 - 1e-9;
    CrumbRig rig(setup);
    rig.floor = false;
    for (Crumb& c : rig.crumbs) {
      if (!c.fixed) c.velocity = Vec3(1e-3, 0, 2e-3);
    }
    for (int step = 0; step < 2000; ++step) rig.step();
    return height_of_all(rig);
  };
  EXPECT_GT(height_after(0.5), 0.002);
  EXPECT_LT(height_after(0.0), 0.0);
}

// Four nodes on a ball as large as a hill, which is a plane for them.
struct Slope {
  static constexpr double kHill = 100;

  explicit Slope(double degrees, double tau)
      : rig({.positions =
                 {{0, -kHill, 0}, {0, 0.0022, 0}, {0.0044, 0.0022, 0}, {0, 0.0022, 0.0044}, {0.0044, 0.0022, 0.0044}},
             .labels = {0, 1, 1, 1, 1},
             .tau = tau,
             .fixed_crumbs = {0},
             .radii = {kHill, 0.0022, 0.0022, 0.0022, 0.0022}}) {
    const double angle = degrees * 0.017453292519943295;
    rig.gravity = 9.81 * Vec3(std::sin(angle), -std::cos(angle), 0);
    rig.floor = false;
  }
  double run(double seconds) {
    const double before = rig.crumbs[1].center.x();
    for (double time = 0; time < seconds - rig.tau / 2; time += rig.tau) rig.step();
    return rig.crumbs[1].center.x() - before;
  }
  CrumbRig rig;
};

TEST(BallPiles, BlockSticksBelowTheFrictionAngleAndSlidesAbove) {  // 26.6 degrees
  for (const double tau : {5e-4, 1e-3, 2.9e-3}) {
    Slope gentle(24, tau);
    gentle.run(1);
    EXPECT_LT(std::abs(gentle.run(2)), 1e-9) << "creeps";
    Slope steep(30, tau);
    steep.run(0.2);
    const double speed = steep.rig.crumbs[1].velocity.x(), way = steep.run(0.2);
    const double acceleration = 9.81 * (0.5 - 0.5 * std::sqrt(0.75));
    EXPECT_NEAR((way - speed * 0.2) * 2 / 0.04, acceleration, 0.03 * acceleration) << tau;
  }
}

}  // namespace
}  // namespace crumble
