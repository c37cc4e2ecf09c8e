// Loose bodies as a whole: they fall, land, slide and stick as solid things do.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "crumble/bubblemesh/presets.hpp"
#include "crumble/sim/simulation.hpp"

namespace crumble {
namespace {

SimulationDef cube_on_the_floor(double height, Friction friction, const Vec3& gravity = {0, -9.81, 0}) {
  static const TetMesh kMesh = generate_paper_body(PaperBody::cube).mesh;
  SimulationDef def;
  def.mesh = kMesh;
  for (Vec3& p : def.mesh.positions) p.y() += height;
  def.walls[0].friction = friction;
  def.gravity = gravity;
  def.step.energy_audit = true;
  return def;
}

Vec3 mean(VecView values) {
  Vec3 sum = Vec3::Zero();
  for (std::size_t i = 0; i < values.size(); ++i) sum += values[i];
  return sum / static_cast<double>(values.size());
}

double lowest(const Simulation& sim) {
  return *std::min_element(sim.positions().y.begin(), sim.positions().y.end());
}

TEST(LooseBody, FallsTenCentimetresAsGalileiSays) {
  Simulation sim(cube_on_the_floor(0.1, {}));
  const double drop = 0.1, expected = std::sqrt(2 * drop / 9.81);
  while (lowest(sim) > 0 && sim.info().time < 1) sim.step({});
  EXPECT_NEAR(sim.info().time, expected, 0.001 + 0.01 * expected);  // 2 % of the way is 1 % of the time
}

TEST(LooseBody, ADragAgainstTheRoomHoldsItBack) {
  SimulationDef def = cube_on_the_floor(0.1, {});
  def.step.drag_frame = DragFrame::room;
  Simulation sim(def);
  for (int s = 0; s < 143; ++s) sim.step({});
  EXPECT_GT(lowest(sim), 0.0999);
}

TEST(LooseBody, ComesToRestWhereItLandsAndTheLedgerAddsUp) {
  Simulation sim(cube_on_the_floor(0.1, {0.5, 0.5}));
  for (int s = 0; s < 1000; ++s) sim.step({});
  EXPECT_EQ(sim.counters().cuts, 0u);
  EXPECT_GE(lowest(sim), -1e-6);
  EXPECT_LE(norm(mean(sim.velocities())), 1e-4);
  const EnergyLedger& ledger = sim.ledger();
  EXPECT_LE(ledger.gain_max_relative, 1e-12);
  const double sum = ledger.tool_work + ledger.external_work - ledger.dissipated - ledger.cut;
  EXPECT_NEAR(ledger.stored, sum, 1e-12 * ledger.external_work);
}

TEST(LooseBody, SlidesDownASlopeByGravityLessFriction) {
  constexpr double kDown = 5, kPress = 8, kFriction = 0.3;  // m/s^2: the slope is in the gravity
  Simulation sim(cube_on_the_floor(0, {kFriction, kFriction}, {kDown, -kPress, 0}));
  for (int s = 0; s < 200; ++s) sim.step({});
  const double from = mean(sim.velocities()).x();
  for (int s = 0; s < 400; ++s) sim.step({});
  const double acceleration = (mean(sim.velocities()).x() - from) / 0.4;
  EXPECT_NEAR(acceleration, kDown - kFriction * kPress, 0.02 * kDown);
  EXPECT_LE(sim.ledger().gain_max_relative, 1e-12);
}

TEST(LooseBody, SticksOnASlopeBelowTheAngleOfFriction) {
  Simulation sim(cube_on_the_floor(0, {0.3, 0.3}, {2, -8, 0}));
  for (int s = 0; s < 1000; ++s) sim.step({});
  const double settled = mean(sim.positions()).x();
  for (int s = 0; s < 2000; ++s) sim.step({});
  EXPECT_NEAR(mean(sim.positions()).x(), settled, 5e-5);  // it still shears a little
  EXPECT_LE(norm(mean(sim.velocities())), 2e-5);
}

TEST(LooseBody, ASpinningOneTumblesOnTheFloorAndComesToRest) {
  SimulationDef def = cube_on_the_floor(0.03, {0.5, 0.5});
  for (Vec3& p : def.mesh.positions) {  // on an edge, nearly
    const Vec3 q = p;
    p.x() = 0.7660444431189780 * q.x() - 0.6427876096865393 * q.y();
    p.y() = 0.6427876096865393 * q.x() + 0.7660444431189780 * q.y() + 0.01;
  }
  Simulation sim(def);
  double least = 1e300;
  for (int s = 0; s < 3000; ++s) {
    sim.step({});
    ASSERT_EQ(sim.info().status, Code{});
    least = std::min(least, sim.ledger().stored);
  }
  EXPECT_LE(norm(mean(sim.velocities())), 1e-3);
  EXPECT_GE(lowest(sim), -1e-5);
  // it lies on a face: half of its nodes' heights are below 15 mm
  EXPECT_NEAR(mean(sim.positions()).y(), 0.015, 0.001);
  EXPECT_LE(sim.ledger().gain_max_relative, 1e-9);
}

}  // namespace
}  // namespace crumble
