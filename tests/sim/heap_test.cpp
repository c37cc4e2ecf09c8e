// Fragments on fragments: a heap of crumbs and a stack of two bodies come to rest and stay what they are.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include "crumble/base/memory.hpp"
#include "crumble/tetmesh/lattice_box.hpp"
#include "sim/heap_rig.hpp"

namespace crumble {
namespace {

// Half the mean rest length of each node's springs, which is what a ball's radius is said to be.
Vector<double> ball_radii(const SpringNetwork& network) {
  Vector<double> sums(network.node_count()), counts(network.node_count());
  for (std::size_t s = 0; s < network.spring_count(); ++s) {
    for (const std::uint32_t node : network.springs[s]) sums[node] += network.rest_lengths[s], counts[node] += 1;
  }
  for (std::size_t i = 0; i < sums.size(); ++i) sums[i] *= 0.5 / counts[i];
  return sums;
}

double kinetic_energy(const Simulation& sim) {
  double sum = 0;
  for (std::size_t i = 0; i < sim.velocities().size(); ++i) {
    sum += sim.network().masses[i] / 2 * squared_norm(sim.velocities()[i]);
  }
  return sum;
}

std::size_t count_faster(const Simulation& sim, double speed) {
  std::size_t count = 0;
  for (std::size_t i = 0; i < sim.velocities().size(); ++i) count += !(norm(sim.velocities()[i]) <= speed);
  return count;
}

double lowest(const Simulation& sim) {
  return *std::min_element(sim.positions().y.begin(), sim.positions().y.end());
}

struct Heap : testing::Test {
  static void SetUpTestSuite() {
    rig = std::make_unique<HeapRig>();
    rig->stir_until(200, 20);
    rig->lift();
    rig->wait(3000);
  }
  static void TearDownTestSuite() { rig.reset(); }
  static std::unique_ptr<HeapRig> rig;
};
std::unique_ptr<HeapRig> Heap::rig;

TEST_F(Heap, LiesStillThreeSecondsAfterItWasStirred) {
  ASSERT_GE(rig->fragment_count(), 200u);
  const std::size_t nodes = rig->sim.network().node_count();
  double energy = 0, low = 0;
  std::size_t fast = 0;
  constexpr int kSteps = 1000;
  for (int s = 0; s < kSteps; ++s) {
    rig->wait(1);
    energy += kinetic_energy(rig->sim) / kSteps;
    fast += count_faster(rig->sim, 0.005);
    low = std::min(low, lowest(rig->sim));
  }
  EXPECT_EQ(rig->sim.info().status, Code{});
  EXPECT_LE(energy, 1e-7);  // J: as if all of its 30 g went at 3 mm/s
  // a crumb that touches another by a hair again and again goes at up to 2 cm/s
  EXPECT_LE(static_cast<double>(fast), 0.01 * kSteps * static_cast<double>(nodes));
  EXPECT_GE(low, -1e-4);
}

// Crumbs that the springs of a greater fragment hold in its jaws are the ones pressed deep.
TEST_F(Heap, CrumbsDoNotSinkIntoEachOther) {
  const Vector<double> radii = ball_radii(rig->sim.network());
  const std::size_t pairs = rig->sim.ball_contact_count();
  ASSERT_GT(pairs, 500u);
  std::size_t deep = 0;
  for (std::size_t k = 0; k < pairs; ++k) {
    const BallContact contact = rig->sim.ball_contact(k);
    const double distance = norm(rig->sim.positions()[contact.first] - rig->sim.positions()[contact.second]);
    deep += !(distance >= 0.5 * (radii[contact.first] + radii[contact.second]));
  }
  EXPECT_LE(static_cast<double>(deep), 0.02 * static_cast<double>(pairs));
}

TEST(HeapState, GoesOnFromASnapshotToTheLastBit) {
  HeapRig rig(Precision::float32), other(Precision::float32);
  rig.stir_until(60, 20);
  ASSERT_GT(rig.sim.ball_contact_count(), 100u);
  other.sim.restore(rig.sim.snapshot());
  other.stirred = rig.stirred;
  for (int s = 0; s < 500; ++s) rig.stir(), other.stir();
  rig.wait(100), other.wait(100);
  EXPECT_EQ(rig.sim.state_hash(), other.sim.state_hash());
  EXPECT_GT(rig.fragment_count(), 60u);
}

// Two boxes in one mesh, `gap` between them.
SimulationDef stack(double edge, double gap) {
  const TetMesh box = make_lattice_box({edge, edge, edge}, edge / 4);
  Vector<Vec3> positions = box.positions;
  Vector<Tetrahedron> tetrahedra = box.tetrahedra;
  const auto nodes = static_cast<std::uint32_t>(box.node_count());
  for (const Vec3& p : box.positions) positions.push_back(p + Vec3(0, edge + gap, 0));
  for (Tetrahedron t : box.tetrahedra) {
    for (std::uint32_t& node : t) node += nodes;
    tetrahedra.push_back(t);
  }
  SimulationDef def;
  def.mesh = make_tet_mesh(std::move(positions), std::move(tetrahedra));
  def.material.mass = 0.02;
  def.walls[0].friction = {0.6, 0.5};
  return def;
}

struct Span {
  double low = 1, high = -1;
};
Span heights(const Simulation& sim, std::size_t first, std::size_t last) {
  Span span;
  for (std::size_t i = first; i < last; ++i) {
    span.low = std::min(span.low, sim.positions().y[i]), span.high = std::max(span.high, sim.positions().y[i]);
  }
  return span;
}

TEST(TwoBodies, OneDroppedOnTheOtherComesToRestOnIt) {
  constexpr double kEdge = 0.02, kGap = 0.01;
  Simulation sim(stack(kEdge, kGap));
  const std::size_t all = sim.mesh().node_count(), half = all / 2;
  ASSERT_EQ(sim.fragments().count(), 2u);
  EXPECT_EQ(sim.ball_contact_count(), 0u);
  for (int s = 0; s < 3000; ++s) sim.step({});
  EXPECT_EQ(sim.counters().cuts, 0u);
  EXPECT_EQ(count_faster(sim, 0.005), 0u);
  const Span lower = heights(sim, 0, half), upper = heights(sim, half, all);
  EXPECT_GE(lower.low, -1e-4);
  // surfaces are drawn through the centers of the balls, so two lie apart by about a ball
  EXPECT_GT(upper.low, lower.high + 0.5 * kEdge / 4);
  EXPECT_LT(upper.low, lower.high + 1.5 * kEdge / 4);
  double carried = 0;
  for (std::size_t k = 0; k < sim.ball_contact_count(); ++k) {
    const BallContact contact = sim.ball_contact(k);
    ASSERT_NE(contact.first < half, contact.second < half);
    carried += (contact.first < half ? -1 : 1) * contact.force.y();
  }
  double weight = 0;
  for (std::size_t i = half; i < all; ++i) weight += 9.81 * sim.network().masses[i];
  EXPECT_NEAR(carried, weight, 0.01 * weight);
}

// Each advances tau, and bodies touch in all of them.
// What a hit wakes is loose again: without a floor it falls like a stone, and not through syrup.
TEST(TwoBodies, ASleeperThatIsHitFalls) {
  SimulationDef def = stack(0.02, 0.01);
  def.walls.clear();
  Simulation sim(def);
  const std::size_t all = sim.mesh().node_count(), half = all / 2;
  sim.set_fragment_state(0, FragmentState::asleep);
  for (int s = 0; s < 300 && sim.counters().woken == 0; ++s) sim.step({});
  ASSERT_EQ(sim.counters().woken, 1u);
  for (int s = 0; s < 20; ++s) sim.step({});
  const auto speed = [&] {
    double sum = 0;
    for (std::size_t i = 0; i < half; ++i) sum += sim.velocities().y[i];
    return sum / static_cast<double>(half);
  };
  const double before = speed();
  for (int s = 0; s < 50; ++s) sim.step({});
  EXPECT_LT(speed() - before, -0.9 * 9.81 * 0.05);
}

TEST(TwoBodies, TwoIterationsAreTwoStepsWhereNothingElseTouches) {
  SimulationDef def = stack(0.02, 0.008);
  def.walls.clear();
  def.gravity = Vec3::Zero();
  def.step.tau = 2e-4;
  def.step.policy = TimeStepPolicy::unchecked;
  def.step.energy_audit = true;
  Simulation one(def);
  def.step.iterations = 2;
  Simulation two(def);
  const std::size_t all = def.mesh.node_count();
  VecArray forces(all);
  for (std::size_t i = all / 2; i < all; ++i) forces.set(i, {0, -5 * one.network().masses[i], 0});
  one.set_node_forces(forces), two.set_node_forces(forces);
  std::size_t touching = 0;
  for (int s = 0; s < 1000; ++s) {
    one.step({}), one.step({});
    two.step({});
    touching += two.ball_contact_count() > 0;
    for (std::uint32_t i = 0; i < all; ++i) ASSERT_EQ(one.positions()[i], two.positions()[i]) << s;
  }
  EXPECT_GT(touching, 100u);
  EXPECT_NEAR(two.ledger().external_work, one.ledger().external_work, 1e-9 * one.ledger().external_work);
}

}  // namespace
}  // namespace crumble
