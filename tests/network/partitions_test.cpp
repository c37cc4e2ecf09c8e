// Bodies large enough to be shared: any number of threads gives the same bits, and the halos add up.
#include <gtest/gtest.h>

#include <thread>

#include "crumble/base/memory.hpp"
#include "network/near_reference.hpp"
#include "network/same_bits.hpp"
#include "network/violence.hpp"
#include "support/allocation_counter.hpp"

namespace crumble {
namespace {

const Vector<Body>& large_bodies() {
  static const Vector<Body> bodies = [] {
    Random random(3);
    Vector<Body> all;
    all.push_back({"rows", make_lattice_box({0.09, 0.03, 0.03}, 0.03 / 14.5)});
    all.push_back({"bubbles", bubble_cube(0.03, 0.00155, Structure::lattice)});
    all.push_back({"random points", random_mesh(9000, random)});
    return all;
  }();
  return bodies;
}

// A host that hands the tasks out last first, half of them to a thread of its own.
void run_backwards(void*, std::uint32_t count, void (*task)(void*, std::uint32_t), void* data) {
  std::thread other([&] {
    for (std::uint32_t i = 0; i < count; i += 2) task(data, i);
  });
  for (std::uint32_t i = count; i-- > 0;) {
    if (i % 2 == 1) task(data, i);
  }
  other.join();
}

TEST(Partitions, AnyNumberOfThreadsGivesTheSameBits) {
  Random random(43);
  for (const Body& body : large_bodies()) {
    for (const Precision precision : {Precision::float64, Precision::float32}) {
      Violence v(body.mesh, random, 10);
      ASSERT_GT(v.network.spring_count(), 50'000u) << body.name;
      const auto c = make_coefficients(v.network, 1e-3, TimeStepPolicy::guard);
      Vector<SolverSettings> all(6, settings_of(precision, "", 3, 0.5));
      all[0].kernel = all[5].kernel = "scalar";
      all[2].threads = 2, all[3].threads = all[5].threads = 4;
      all[4].host_threads.run = run_backwards;
      Vector<std::unique_ptr<NetworkSolver>> solvers;
      for (const SolverSettings& settings : all) {
        solvers.push_back(NetworkSolver::make(v.network, c, v.rest, settings));
      }
      ASSERT_GE(solvers[0]->layout().partitions, 2u) << body.name;
      for (int round = 0; round < 2; ++round) {
        v.shake(random, round == 0 ? 1 : 1e-3);
        for (auto& solver : solvers) v.put(*solver);
        for (int step = 0; step < 3; ++step) {
          auto expected = v.constraints;
          solvers[0]->solve(expected);
          for (std::size_t k = 1; k < solvers.size(); ++k) {
            auto held = v.constraints;
            solvers[k]->solve(held);
            ASSERT_TRUE(same_bits(*solvers[0], expected, *solvers[k], held)) << body.name << ", solver " << k;
          }
        }
      }
    }
  }
}

TEST(Partitions, AgreeWithTheReference) {
  Random random(47);
  for (const Body& body : large_bodies()) {
    for (const Precision precision : {Precision::float64, Precision::float32}) {
      Violence v(body.mesh, random, 10);
      const auto c = make_coefficients(v.network, 1e-3, TimeStepPolicy::guard);
      const SolverSettings settings = settings_of(precision, "", 0, 0);
      const auto solver = NetworkSolver::make(v.network, c, v.rest, settings);
      Reference reference(v.network, c, v.rest, settings);
      v.put(*solver), v.put(reference);
      for (int step = 0; step < 3; ++step) {  // each begins where the solver is, and with nothing left of the last
        for (std::uint32_t i = 0; i < v.rest.size(); ++i) {
          reference.positions[i] = solver->position(i), reference.velocities[i] = solver->velocity(i);
        }
        const Reference before = reference;
        solver->solve({}), reference.solve({});
        expect_near(*solver, before, reference, c, precision == Precision::float32 ? 4e-6 : 1e-14, body.name);
      }
    }
  }
}

// The force on a held node is summed apart from the others'.
TEST(Partitions, AHeldNodeFeelsTheForceThatWouldMoveIt) {
  Random random(53);
  for (const Body& body : large_bodies()) {
    Violence v(body.mesh, random, 10);
    const auto c = make_coefficients(v.network, 1e-3, TimeStepPolicy::guard);
    const auto solver = NetworkSolver::make(v.network, c, v.rest, {});
    v.put(*solver);
    VecArray forces(v.rest.size());
    solver->read_forces(forces);
    Vector<NodeConstraint> all(v.rest.size());
    for (std::uint32_t i = 0; i < all.size(); ++i) {
      all[i].node = i;
      all[i].normal = normalized(Vec3(-forces[i]) + 1e-9 * Vec3::UnitX());
      all[i].static_friction = 10;
    }
    solver->solve(all);
    for (std::uint32_t i = 1; i < all.size(); ++i) {
      ASSERT_EQ(all[i].state, ContactState::stick);
      ASSERT_EQ(all[i].reaction, -forces[i]);
      ASSERT_EQ(solver->position(i), v.positions[i]);
    }
    const auto free = NetworkSolver::make(v.network, c, v.rest, {});
    v.put(*free);
    free->solve({});
    for (std::uint32_t i = 1; i < all.size(); ++i) {
      const Vec3 moved = v.positions[i] + (c.drift[i] * v.velocities[i] + c.force_gain[i] * forces[i]);
      ASSERT_EQ(free->position(i), moved) << body.name << ", node " << i;
    }
  }
}

TEST(Partitions, SolvingTakesNoMemory) {
  if (!AllocationCounter::available()) GTEST_SKIP() << "a sanitizer owns malloc";
  Random random(59);
  for (const Body& body : large_bodies()) {
    for (const std::uint32_t threads : {1u, 2u}) {
      Violence v(body.mesh, random, 10);
      v.shake(random, 1);
      const auto c = make_coefficients(v.network, 1e-3, TimeStepPolicy::guard);
      SolverSettings settings = settings_of(threads == 1 ? Precision::float64 : Precision::float32, "", 1.2, 0.5);
      settings.threads = threads;
      const auto solver = NetworkSolver::make(v.network, c, v.rest, settings);
      v.put(*solver);
      VecArray forces(v.external);
      std::size_t allocations = 1, overlong = 0;
      {
        const AllocationCounter counter;
        for (int step = 0; step < 3; ++step) {
          solver->solve(v.constraints);
          overlong += solver->overlong().size();
          for (const std::uint32_t s : solver->overlong()) solver->set_share(s, 0);
          solver->place(5, v.positions[7], v.velocities[7]);
          solver->inside({-1, -1, -1}, {1, 1, 1}), solver->behind({normalized(Vec3(1, 2, 3)), 0.01});
          solver->set_external(forces);
          solver->reset();
        }
        allocations = counter.count();
      }
      EXPECT_EQ(allocations, 0u) << body.name;
      EXPECT_GT(overlong, 1000u);
    }
  }
}

}  // namespace
}  // namespace crumble
