// A slow creep does not stall in floats: docs/numerics.md promises the sag to 0.01 % and the rate to 1 %.
//
// A cube under its weight sags by about 51 micrometres and takes seconds for it. Its nodes are 30 mm from the origin,
// where neighbouring floats are 1.9 nm apart; soon they creep by less than half of that per step, and a plain float
// coordinate stays where it is.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "crumble/base/memory.hpp"
#include "network/bodies.hpp"
#include "network/reference.hpp"

namespace crumble {
namespace {

constexpr double kTau = 1e-3;
constexpr int kSeconds = 16;

enum class Held { at_top, at_bottom };

Vector<std::uint32_t> nodes_at(const TetMesh& mesh, double height) {
  Vector<std::uint32_t> nodes;
  for (std::uint32_t i = 0; i < mesh.node_count(); ++i) {
    if (std::abs(mesh.positions[i].y() - height) < 1e-6) nodes.push_back(i);
  }
  return nodes;
}

// What a float coordinate without its rest would do.
void drop_rests(NetworkSolver& solver) {
  for (std::uint32_t i = 0; i < solver.node_count(); ++i) {
    solver.place(i, solver.position(i).cast<float>().cast<double>(), solver.velocity(i));
  }
}

// Mean way down of the nodes farthest from the held ones, metres, after each second.
Vector<double> sag_of(Held held, Precision precision, bool plain = false) {
  static const TetMesh mesh = make_lattice_box({0.03, 0.03, 0.03}, 0.0044);
  constexpr double kEnds[] = {0.03, 0};
  const bool top = held == Held::at_top;
  Material material;
  material.stiffness = 285;
  const SpringNetwork network = make_network(mesh, material, MassRule::lumped, nodes_at(mesh, kEnds[top ? 0 : 1]));
  const auto c = make_coefficients(network, kTau, TimeStepPolicy::guard);
  const auto solver = NetworkSolver::make(network, c, mesh.positions, settings_of(precision));
  VecArray weight(mesh.node_count());
  for (std::size_t i = 0; i < mesh.node_count(); ++i) weight.y[i] = -9.81 * network.masses[i];
  solver->set_external(weight);
  const auto free_end = nodes_at(mesh, kEnds[top ? 1 : 0]);
  Vector<double> sag;
  for (int second = 0; second < kSeconds; ++second) {
    for (int step = 0; step < 1000; ++step) {
      solver->solve({});
      if (plain) drop_rests(*solver);
    }
    double sum = 0;
    for (const std::uint32_t node : free_end) sum += mesh.positions[node].y() - solver->position(node).y();
    sag.push_back(sum / static_cast<double>(free_end.size()));
  }
  return sag;
}

double rate_between(const Vector<double>& sag, std::size_t second) {
  return sag[second + 1] - sag[second];
}

TEST(Precision, FloatsCreepAtTheRightRateToTheRightSag) {
  for (const Held held : {Held::at_top, Held::at_bottom}) {
    const auto exact = sag_of(held, Precision::float64), sag = sag_of(held, Precision::float32);
    EXPECT_NEAR(exact.back(), 51e-6, 1e-6);
    EXPECT_NEAR(sag.back() / exact.back(), 1, 1e-4);
    constexpr double kHalfSpacing = 0.93e-9;  // of floats at 30 mm
    double slowest = kHalfSpacing;
    for (std::size_t second = 0; second + 1 < exact.size(); ++second) {
      const double per_step = rate_between(exact, second) * kTau;
      if (per_step < 0.03 * kHalfSpacing) break;  // 0.2 % of the sag is left to go
      slowest = std::min(slowest, per_step);
      EXPECT_NEAR(rate_between(sag, second) / rate_between(exact, second), 1, 0.01) << "second " << second;
    }
    EXPECT_LT(slowest, 0.05 * kHalfSpacing);
  }
}

TEST(Precision, PlainFloatsWouldStall) {
  for (const Held held : {Held::at_top, Held::at_bottom}) {
    const auto exact = sag_of(held, Precision::float64), sag = sag_of(held, Precision::float32, true);
    EXPECT_LT(sag.back(), (1 - 2e-3) * exact.back());
    const std::size_t last = exact.size() - 2;
    EXPECT_LT(rate_between(sag, last), 0.1 * rate_between(exact, last));
  }
}

}  // namespace
}  // namespace crumble
