// Copies, saved states and resets go on with the same bits.
#include <gtest/gtest.h>

#include "network/same_bits.hpp"
#include "network/violence.hpp"

namespace crumble {
namespace {

struct Started {
  Violence v;
  std::unique_ptr<NetworkSolver> solver;
};

Started start(const Body& body, Precision precision, Random& random) {
  Violence v(body.mesh, random, 10);
  const auto c = make_coefficients(v.network, 1e-3, TimeStepPolicy::guard);
  auto solver = NetworkSolver::make(v.network, c, v.rest, settings_of(precision, "", 3, 0.5));
  v.put(*solver);
  for (int step = 0; step < 3; ++step) {
    auto held = v.constraints;
    solver->solve(held);
  }
  return {std::move(v), std::move(solver)};
}

void expect_same_future(const Started& run, NetworkSolver& other) {
  const auto copy = run.solver->clone();
  for (int step = 0; step < 5; ++step) {
    auto held = run.v.constraints, held_too = run.v.constraints;
    copy->solve(held), other.solve(held_too);
    ASSERT_TRUE(same_bits(*copy, held, other, held_too)) << "step " << step;
  }
}

TEST(Continuity, ACopyGoesOnAndLeavesTheOriginalAlone) {
  Random random(61);
  for (const Body& body : small_bodies()) {
    for (const Precision precision : {Precision::float64, Precision::float32}) {
      Started run = start(body, precision, random);
      const std::uint64_t before = state_bits(*run.solver);
      const auto copy = run.solver->clone();
      expect_same_future(run, *copy);
      copy->set_share(0, 0), copy->reset();
      EXPECT_EQ(state_bits(*run.solver), before);
    }
  }
}

TEST(Continuity, ASavedStateGoesOnOnceItsSpringsAreCutAgain) {
  Random random(67);
  for (const Body& body : small_bodies()) {
    for (const Precision precision : {Precision::float64, Precision::float32}) {
      Started run = start(body, precision, random);
      ByteWriter out;
      run.solver->save(out);
      const auto other = run.solver->clone();
      Violence elsewhere = run.v;
      elsewhere.shake(random);
      elsewhere.put(*other);
      ByteReader in(out.bytes(), "test");
      other->load(in);
      EXPECT_EQ(in.left(), 0u);
      EXPECT_TRUE(other->overlong().empty());
      EXPECT_EQ(state_bits(*other), state_bits(*run.solver));
      // load() mended what `elsewhere` had cut
      const auto mended = run.solver->clone();
      for (std::uint32_t s = 0; s < run.v.shares.size(); ++s) mended->set_share(s, 1);
      VecArray forces(run.v.external);
      mended->set_external(forces), other->set_external(forces);
      EXPECT_EQ(force_bits(*other), force_bits(*mended)) << body.name;
      for (std::uint32_t s = 0; s < run.v.shares.size(); ++s) other->set_share(s, run.v.shares[s]);
      expect_same_future(run, *other);
    }
  }
}

TEST(Continuity, ATruncatedStateIsRefused) {
  Random random(71);
  for (const Precision precision : {Precision::float64, Precision::float32}) {
    Started run = start(small_bodies()[5], precision, random);
    ByteWriter out;
    run.solver->save(out);
    for (std::size_t size = 0; size < out.bytes().size(); size += 61) {
      ByteReader in(std::span(out.bytes()).first(size), "test");
      EXPECT_THROW(run.solver->clone()->load(in), Error) << size;
    }
    Started other = start(small_bodies()[6], precision, random);
    ByteReader in(out.bytes(), "test");
    EXPECT_THROW(other.solver->load(in), Error);  // of another body
  }
}

TEST(Continuity, ResetIsANewSolver) {
  Random random(73);
  for (const Body& body : small_bodies()) {
    for (const Precision precision : {Precision::float64, Precision::float32}) {
      Started run = start(body, precision, random);
      const auto c = make_coefficients(run.v.network, 1e-3, TimeStepPolicy::guard);
      const auto fresh = NetworkSolver::make(run.v.network, c, run.v.rest, settings_of(precision, "", 3, 0.5));
      fresh->set_external(VecArray(run.v.external));
      run.solver->reset();
      EXPECT_TRUE(run.solver->overlong().empty());
      EXPECT_TRUE(same_bits(*run.solver, {}, *fresh, {})) << body.name;
      for (std::uint32_t i = 0; i < run.v.rest.size(); ++i) {
        ASSERT_LE(norm(run.solver->position(i) - run.v.rest[i]), precision == Precision::float32 ? 1e-15 : 0);
      }
      expect_same_future(run, *fresh);
    }
  }
}

}  // namespace
}  // namespace crumble
