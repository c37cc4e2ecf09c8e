// One loose body of a few nodes, and its sums.
#pragma once

#include <memory>
#include <numeric>

#include "crumble/base/memory.hpp"
#include "crumble/network/energy.hpp"
#include "network/violence.hpp"

namespace crumble {

inline constexpr double kTau = 1e-3;

// One loose body, nothing fixed.
struct Loose {
  TetMesh mesh;
  SpringNetwork network;
  std::unique_ptr<NetworkSolver> solver;
  VecArray positions, velocities;

  explicit Loose(TetMesh body, double tau = kTau, Precision precision = Precision::float64, Material material = {})
      : mesh(std::move(body)), network(make_network(mesh, material, MassRule::lumped, {})) {
    make(tau, precision);
  }
  void make(double tau, Precision precision) {
    solver = NetworkSolver::make(network, make_coefficients(network, tau, TimeStepPolicy::guard), mesh.positions,
                                 settings_of(precision));
    positions = velocities = VecArray(mesh.node_count());
    Vector<std::uint32_t> nodes(mesh.node_count());
    std::iota(nodes.begin(), nodes.end(), 0u);
    const Vector<std::uint32_t> first{0, static_cast<std::uint32_t>(nodes.size())};
    solver->set_loose({first, nodes});
    read();
  }
  void read() {
    solver->read_positions(0, positions);
    solver->read_velocities(velocities);
  }
  void step(std::span<NodeConstraint> constraints = {}) {
    solver->solve(constraints);
    read();
  }
  double mass() const { return std::accumulate(network.masses.begin(), network.masses.end(), 0.0); }
  Vec3 center() const {
    Vec3 sum = Vec3::Zero();
    for (std::size_t i = 0; i < positions.size(); ++i) sum += network.masses[i] * positions[i];
    return sum / mass();
  }
  Vec3 momentum() const {
    Vec3 sum = Vec3::Zero();
    for (std::size_t i = 0; i < positions.size(); ++i) sum += network.masses[i] * velocities[i];
    return sum;
  }
  Vec3 angular_momentum() const {
    Vec3 sum = Vec3::Zero();
    const Vec3 c = center();
    for (std::size_t i = 0; i < positions.size(); ++i) {
      sum += network.masses[i] * cross(positions[i] - c, velocities[i]);
    }
    return sum;
  }
  double energy() const {
    return spring_energy(network, positions, network.stiffnesses) + kinetic_energy(network, velocities);
  }
  void weigh(const Vec3& gravity) {
    VecArray weights(mesh.node_count());
    for (std::size_t i = 0; i < weights.size(); ++i) weights.set(i, network.masses[i] * gravity);
    solver->set_external(weights);
  }
  void shake(Random& random, double share, double speed, const Vec3& spin) {
    for (std::uint32_t i = 0; i < mesh.node_count(); ++i) {
      const Vec3 at = mesh.positions[i] + random_vector(random, 0.01 * share);
      solver->place(i, at, random_vector(random, speed) + cross(spin, at));
    }
    read();
  }
};

inline TetMesh small_box() {
  return make_lattice_box({0.02, 0.02, 0.03}, 0.01);
}

}  // namespace crumble
