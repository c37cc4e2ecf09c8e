// What the solver keeps of loose bodies between steps: boxes for the search, low parts of floats, who is loose.
#include <gtest/gtest.h>

#include <algorithm>

#include "crumble/base/memory.hpp"
#include "network/loose_body.hpp"

namespace crumble {
namespace {

TEST(LooseState, ASearchFindsAFastBodyWhereItIsNow) {
  Loose body(small_box());
  for (std::uint32_t i = 0; i < body.mesh.node_count(); ++i) {
    body.solver->place(i, body.mesh.positions[i], Vec3(100, 0, 0));  // 0.1 m in a step
  }
  body.step();
  const Vec3 margin = Vec3::Constant(1e-6);
  for (std::uint32_t i = 0; i < body.mesh.node_count(); ++i) {
    const Vec3 at = body.positions[i];
    EXPECT_NEAR(at.x(), body.mesh.positions[i].x() + 0.1, 1e-9);
    const auto found = body.solver->inside(at - margin, at + margin);
    EXPECT_EQ(std::count(found.begin(), found.end(), i), 1);
    const auto behind = body.solver->behind({Vec3::UnitX(), at.x() + 1e-6});
    EXPECT_EQ(std::count(behind.begin(), behind.end(), i), 1);
  }
}

// A step of 1e-9 m is half a unit in the last place of a float of 2 cm.
TEST(LooseState, FloatsCarryADriftBelowTheirLastPlace) {
  Loose body(small_box(), kTau, Precision::float32);
  for (std::uint32_t i = 0; i < body.mesh.node_count(); ++i) {
    body.solver->place(i, body.mesh.positions[i], Vec3(1e-6, 0, 0));
  }
  body.read();
  const Vec3 before = body.center();
  for (int s = 0; s < 1000; ++s) body.solver->solve({});
  body.read();
  EXPECT_NEAR(body.center().x() - before.x(), 1e-6, 1e-9);
}

TEST(LooseState, WhoIsNoLongerLooseIsHeldLikeAnyOther) {
  Loose body(small_box()), never(small_box());
  never.solver = NetworkSolver::make(never.network, make_coefficients(never.network, kTau, TimeStepPolicy::guard),
                                     never.mesh.positions, settings_of(Precision::float64));
  body.solver->set_loose({});
  NodeConstraint held;
  held.node = 4, held.normal = Vec3::UnitY(), held.velocity = Vec3(0.01, 0, 0);
  held.static_friction = 0.5, held.dynamic_friction = 0.3;
  Random random(4);
  for (int s = 0; s < 20; ++s) {
    VecArray forces(body.mesh.node_count());
    for (std::size_t i = 0; i < forces.size(); ++i) forces.set(i, random_vector(random, 0.05));
    body.solver->set_external(forces), never.solver->set_external(forces);
    Vector<NodeConstraint> here{held}, there{held};
    body.step(here), never.step(there);
    ASSERT_EQ(here[0].state, there[0].state);
    for (std::size_t i = 0; i < body.positions.size(); ++i) ASSERT_EQ(body.positions[i], never.positions[i]);
  }
}

}  // namespace
}  // namespace crumble
