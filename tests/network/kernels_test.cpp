// Every kernel gives the bits of the scalar one, and this one what the reference says.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "crumble/base/memory.hpp"
#include "network/near_reference.hpp"
#include "network/same_bits.hpp"
#include "network/violence.hpp"

namespace crumble {
namespace {

constexpr Precision kBoth[] = {Precision::float64, Precision::float32};

// So small that squares, and products with gains, are denormal or nothing.
void make_tiny(Violence& v, Random& random) {
  const double size = std::pow(10.0, random.uniform(-45, -15));
  for (std::size_t i = 0; i < v.rest.size(); ++i) {
    v.positions[i] = random_vector(random, size);
    v.velocities[i] = random_vector(random, size * std::pow(10.0, random.uniform(-20, 10)));
    v.external[i] = random_vector(random, 1e-10 * size);
  }
}

// Some nodes are torn out of the world, by a force or by their speed.
void tear_out(Violence& v, Random& random) {
  constexpr double kForces[] = {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity(),
                                1e30};
  for (const double force : kForces) v.external[random.below(v.rest.size())].z() = force;
  v.velocities[random.below(v.rest.size())] = Vec3(999, -999.9, 999);
  v.positions[random.below(v.rest.size())] = Vec3(-999.99, 1000, 5);
}

void disturb(Violence& v, Random& random, int round) {
  v.shake(random);
  if (round % 4 == 2) make_tiny(v, random);
  if (round % 4 == 3) tear_out(v, random);
}

// Cuts what was too long, at once or by and by.
void cut(Violence& v, NetworkSolver& a, NetworkSolver& b) {
  for (const std::uint32_t s : a.overlong()) v.shares[s] = s % 3 == 0 ? 0 : 0.5;
  for (std::uint32_t s = 0; s < v.shares.size(); ++s) {
    if (v.shares[s] == 1) continue;
    a.set_share(s, v.shares[s]), b.set_share(s, v.shares[s]);
  }
}

TEST(Kernels, GiveTheSameBitsAsScalar) {
  const Vector<std::string> kernels = kernel_names();
  ASSERT_EQ(kernels.front(), "scalar");
  if (kernels.size() == 1) GTEST_SKIP() << "this processor has no other kernel";
  Random random(31);
  std::size_t overlong = 0, lost = 0;
  for (const Body& body : small_bodies()) {
    for (const Precision precision : kBoth) {
      for (std::size_t k = 1; k < kernels.size(); ++k) {
        Violence v(body.mesh, random, random.uniform(0, 30));
        if (k % 2 == 0) shuffle_springs(v.network, random);
        const auto c = make_coefficients(v.network, random.uniform(1e-4, 0.01), TimeStepPolicy::guard);
        const auto scalar = NetworkSolver::make(v.network, c, v.rest, settings_of(precision, "scalar", 2.5, 0.75));
        const auto other = NetworkSolver::make(v.network, c, v.rest, settings_of(precision, kernels[k], 2.5, 0.75));
        ASSERT_EQ(other->kernel(), kernels[k]);
        for (int round = 0; round < 16; ++round) {
          disturb(v, random, round);
          v.put(*scalar), v.put(*other);
          for (int step = 0; step < 3; ++step) {
            auto held = v.constraints, held_too = v.constraints;
            scalar->solve(held), other->solve(held_too);
            ASSERT_TRUE(same_bits(*scalar, held, *other, held_too))
                << kernels[k] << ", " << body.name << ", round " << round << ", step " << step;
            overlong += scalar->overlong().size(), lost += scalar->lost_node().has_value();
            cut(v, *scalar, *other);
          }
        }
      }
    }
  }
  EXPECT_GT(overlong, 1000u);
  EXPECT_GT(lost, 100u);
}

TEST(Kernels, AgreeWithTheReference) {
  Random random(37);
  for (const Body& body : small_bodies()) {
    for (const Precision precision : kBoth) {
      Violence v(body.mesh, random, random.uniform(0, 30));
      shuffle_springs(v.network, random);
      const auto c = make_coefficients(v.network, random.uniform(1e-4, 0.01), TimeStepPolicy::guard);
      const SolverSettings settings = settings_of(precision, "", 3, 0.5);
      const auto solver = NetworkSolver::make(v.network, c, v.rest, settings);
      Reference reference(v.network, c, v.rest, settings);
      for (int round = 0; round < 12; ++round) {
        v.shake(random);
        v.put(*solver), v.put(reference);
        const Reference before = reference;
        auto held = v.constraints, expected = v.constraints;
        solver->solve(held), reference.solve(expected);
        ASSERT_EQ(copied(solver->overlong()), reference.overlong) << body.name;
        // float coordinates of 0.03 m are rounded by 1e-9 m before their difference, 1e-3 m and more, is taken
        const double epsilon = precision == Precision::float32 ? 4e-6 : 1e-14;
        expect_near(*solver, before, reference, c, epsilon, body.name);
        for (std::size_t k = 0; k < held.size(); ++k) {
          // where all pulls cancel but for rounding, the cone may be met or missed
          const std::uint32_t node = held[k].node;
          if (norm(reference.forces[node]) > epsilon * reference.pulls[node]) {
            ASSERT_EQ(held[k].state, expected[k].state) << body.name << ", node " << node;
          }
          ASSERT_LE(norm(held[k].reaction - expected[k].reaction), epsilon * reference.pulls[node]);
        }
      }
    }
  }
}

// Boxes of all sizes, some of whose faces go through nodes; walls at any angle.
TEST(Kernels, SearchesFindTheNodesThatAreThere) {
  Random random(41);
  std::size_t found = 0;
  for (const Body& body : small_bodies()) {
    for (const Precision precision : kBoth) {
      Violence v(body.mesh, random, 10);
      const auto c = make_coefficients(v.network, 1e-3, TimeStepPolicy::guard);
      Vector<std::unique_ptr<NetworkSolver>> solvers;
      for (const std::string& kernel : kernel_names()) {
        solvers.push_back(NetworkSolver::make(v.network, c, v.rest, settings_of(precision, kernel)));
      }
      for (int round = 0; round < 30; ++round) {
        v.shake(random);
        const Vec3 away = random_vector(random, round % 5 == 0 ? 900 : 0);  // floats are coarse there
        for (Vec3& p : v.positions) p += away;
        for (auto& solver : solvers) {
          v.put(*solver);
          if (round % 2 == 0) solver->solve({});  // bounds as the step leaves them, or as place() widens them
        }
        const NetworkSolver& first = *solvers.front();
        const Vec3 at = first.position(static_cast<std::uint32_t>(random.below(v.rest.size())));
        const Vec3 to = at + random_vector(random, std::pow(10.0, random.uniform(-5, -1)));
        const Vec3 low = at.cwiseMin(to), high = at.cwiseMax(to);
        Plane plane{normalized(random_vector(random, 1)), 0};
        if (round % 3 == 0) plane.normal = Vec3::Unit(round % 9 / 3) * (round % 2 == 0 ? 1 : -1);
        plane.offset = dot(plane.normal, at) + random.uniform(0, 0.01);
        const auto inside = copied(solvers.front()->inside(low, high)), behind = copied(solvers.front()->behind(plane));
        found += inside.size();
        for (auto& solver : solvers) {
          ASSERT_EQ(copied(solver->inside(low, high)), inside);
          ASSERT_EQ(copied(solver->behind(plane)), behind);
        }
        Vector<int> in(v.rest.size(), 0), back(v.rest.size(), 0);
        for (const std::uint32_t node : inside) ++in[node];
        for (const std::uint32_t node : behind) ++back[node];
        const double close = 3e-7 * (0.03 + norm(away));  // rounding of float coordinates
        for (std::uint32_t i = 0; i < v.rest.size(); ++i) {
          const Vec3 p = first.position(i);
          const double out = std::max((low - p).maxCoeff(), (p - high).maxCoeff());
          const double height = dot(plane.normal, p) - plane.offset;
          ASSERT_TRUE(in[i] == (out <= 0) || (in[i] == 1 && out < close)) << out;
          ASSERT_TRUE(back[i] == (height < 0) || (back[i] == 1 && height < close)) << height;
        }
      }
    }
  }
  EXPECT_GT(found, 1000u);
}

// Floats at 900 m are 61 micrometres apart, and the boxes round blocks of nodes are made of them.
TEST(Kernels, AWallFindsWhatIsJustBehindItFarAway) {
  const TetMesh mesh = small_bodies().front().mesh;
  const SpringNetwork network = make_network(mesh, {}, MassRule::lumped, {});
  const auto c = make_coefficients(network, 1e-3, TimeStepPolicy::guard);
  const auto solver = NetworkSolver::make(network, c, mesh.positions, settings_of(Precision::float32, "scalar"));
  for (int k = 0; k < 20; ++k) {
    const Vec3 at(0, 900 + 5e-6 * k, 0), normal = normalized(Vec3(1e-4, 1, 0));
    for (std::uint32_t i = 0; i < mesh.node_count(); ++i) solver->place(i, at, Vec3::Zero());
    solver->solve({});  // moves nothing, and draws the boxes tight
    EXPECT_EQ(solver->behind({normal, dot(normal, at) + 1e-7}).size(), mesh.node_count());
    EXPECT_EQ(solver->behind({normal, dot(normal, at) - 1e-7}).size(), 0u);
  }
}

}  // namespace
}  // namespace crumble
