// Golden hashes: the same bits from every compiler at every level of optimisation. scripts/test builds this program
// once with each, and each compares with the constants below.
//
// A change that means to change results fails here first. The failure prints the new line of the table; put it in, and
// say in the commit why the result moved.
#include <gtest/gtest.h>

#include <array>
#include <cinttypes>
#include <cstdio>
#include <ostream>
#include <string>

#include "crumble/base/hash.hpp"
#include "crumble/bubblemesh/presets.hpp"
#include "crumble/sim/simulation.hpp"
#include "crumble/tetmesh/lattice_box.hpp"

namespace crumble {
namespace {

constexpr int kSteps = 3000;

struct Outcome {
  std::uint64_t mesh;   // hash of nodes and tetrahedra at rest
  std::uint64_t state;  // Simulation::state_hash() after kSteps
  std::uint64_t cuts;
  bool operator==(const Outcome&) const = default;
};

struct Golden {
  const char* name;
  SimulationDef (*make)();
  Pose (*pose)(double time);
  Outcome expected;
};

void PrintTo(const Golden& golden, std::ostream* out) {
  *out << golden.name;
}

std::uint64_t mesh_hash(const TetMesh& mesh) {
  Hash hash;
  for (const Vec3& p : mesh.positions) hash.add(p.x()), hash.add(p.y()), hash.add(p.z());
  for (const Tetrahedron& tetrahedron : mesh.tetrahedra) {
    for (const std::uint32_t node : tetrahedron) hash.add(std::uint64_t{node});
  }
  return hash.value();
}

// The paper's cube and stick, on a bottom that holds, without gravity.
SimulationDef paper_cube() {
  SimulationDef def;
  static const TetMesh kMesh = generate_paper_body(PaperBody::cube).mesh;
  def.mesh = kMesh;
  def.fixed_nodes = nodes_below(def.mesh, 1e-6);
  def.gravity = Vec3::Zero();
  def.walls.clear();
  def.tools = {{make_round_stick(0.004, 0.05, 16), {0.5, 0.5}}};
  return def;
}

SimulationDef paper_cube_in_float32() {
  SimulationDef def = paper_cube();
  def.step.precision = Precision::float32;
  return def;
}

SimulationDef paper_cube_by_the_paper() {
  SimulationDef def = paper_cube();
  apply_paper_preset(def);
  return def;
}

// A heavy, loose box on a rough floor under a bar, in exact substeps.
SimulationDef box_on_the_floor() {
  SimulationDef def;
  def.mesh = make_lattice_box({0.03, 0.02, 0.025}, 0.005);
  def.material = {60, 5, 1.15, 0.05};
  def.walls.front().friction = {0.8, 0.6};
  def.tools = {{make_bar({0.006, 0.006, 0.05}), {3.0, 1.5}}};
  def.step.policy = TimeStepPolicy::substep;
  return def;
}

// Straight down at 6 mm/s from the top face.
Pose press(double time) {
  return {{0, 0.034 - 0.006 * time, 0}, Quat::Identity()};
}

Pose slow_press(double time) {
  return {{0, 0.034 - 0.0025 * time, 0}, Quat::Identity()};
}

// Down and sideways, turning about the vertical and about the bar's own axis.
Pose stir(double time) {
  const Quat turn = multiply(axis_angle(Vec3::UnitY(), 0.3 * time), axis_angle(Vec3::UnitZ(), 0.5 * time));
  return {{0.001 * time, 0.024 - 0.007 * time, -0.002 * time}, turn};
}

const std::array kGolden{
    Golden{"cube", paper_cube, press, {0xf65bac874bfca4bd, 0x6019a5fa8cc02269, 169}},
    Golden{"cube_in_float32", paper_cube_in_float32, press, {0xf65bac874bfca4bd, 0xf91ce930d1b4ed89, 168}},
    Golden{"cube_by_the_paper", paper_cube_by_the_paper, slow_press, {0xf65bac874bfca4bd, 0x2d3a21358f07b882, 234}},
    Golden{"box_on_the_floor", box_on_the_floor, stir, {0x4cc273c9bd238ce9, 0x28ac61320689739b, 202}},
};

class GoldenTest : public testing::TestWithParam<Golden> {};

TEST_P(GoldenTest, SameBitsInEveryBuild) {
  const Golden& golden = GetParam();
  Simulation sim(golden.make());
  const double tau = sim.definition().step.tau;
  bool held = false, slid = false;
  for (int step = 1; step <= kSteps; ++step) {
    const Pose pose = golden.pose(step * tau);
    ASSERT_EQ(sim.step({&pose, 1}).status, Code{}) << "step " << step;
    for (const NodeConstraint& c : sim.contacts()) {
      held |= c.state == ContactState::stick;
      slid |= c.state == ContactState::slip;
    }
  }
  // a run in which little happens would prove little
  EXPECT_TRUE(held && slid);
  EXPECT_GT(sim.counters().cuts, 100u);

  const Outcome outcome{mesh_hash(sim.mesh()), sim.state_hash(), sim.counters().cuts};
  char line[100];
  std::snprintf(line, sizeof line, "{0x%016" PRIx64 ", 0x%016" PRIx64 ", %" PRIu64 "}", outcome.mesh, outcome.state,
                outcome.cuts);
  EXPECT_TRUE(outcome == golden.expected) << golden.name << " is now " << line;
}

INSTANTIATE_TEST_SUITE_P(Bodies, GoldenTest, testing::ValuesIn(kGolden),
                         [](const auto& param) { return std::string(param.param.name); });

}  // namespace
}  // namespace crumble
