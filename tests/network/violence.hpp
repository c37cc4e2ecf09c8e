// Violent random states: inverted and torn, at wild speeds, with held, sliding and fixed nodes and wild masses.
#pragma once

#include <algorithm>
#include <cmath>

#include "crumble/base/memory.hpp"
#include "network/bodies.hpp"
#include "network/reference.hpp"

namespace crumble {

// The order of springs and of their ends is the user's.
inline void shuffle_springs(SpringNetwork& network, Random& random) {
  const auto order = random_order(network.spring_count(), random);
  const SpringNetwork before = network;
  for (std::size_t s = 0; s < order.size(); ++s) {
    auto [i, j] = before.springs[order[s]];
    if (random.uniform() < 0.5) std::swap(i, j);
    network.springs[s] = {i, j};
    network.rest_lengths[s] = before.rest_lengths[order[s]];
    // nor need all be alike
    network.stiffnesses[s] = before.stiffnesses[order[s]] * (random.uniform() < 0.3 ? random.uniform(0.2, 1) : 1);
  }
}

struct Violence {
  SpringNetwork network;
  Vector<Vec3> rest;
  Vector<Vec3> positions, velocities, external;  // by node
  Vector<double> shares;                         // by spring
  Vector<NodeConstraint> constraints;

  Violence(const TetMesh& mesh, Random& random, double damping_ratio) : rest(mesh.positions) {
    Material material;
    material.stiffness = std::pow(10.0, random.uniform(0, 4));
    material.damping_ratio = damping_ratio;
    const Vector<std::uint32_t> fixed{0};
    network = make_network(mesh, material, MassRule::lumped, fixed);
    for (std::size_t i = 0; i < network.node_count(); ++i) {
      const double heavier = std::pow(10.0, random.uniform(-2, 2));
      network.masses[i] *= heavier;
      network.drags[i] *= std::sqrt(heavier);
    }
    shake(random);
  }

  /// Another state of the same network. A few are nearly at rest, where there is little energy to hide a gain in.
  void shake(Random& random) { shake(random, random.uniform() < 0.75 ? 1 : std::pow(10.0, random.uniform(-7, 0))); }

  /// `share`: 1 nothing stays where it was, 0 at rest.
  void shake(Random& random, double share) {
    const std::size_t nodes = rest.size();
    positions = rest;
    velocities.assign(nodes, Vec3::Zero());
    external = velocities;
    for (std::size_t i = 1; i < nodes; ++i) {
      positions[i] = (1 - share) * rest[i] + random_vector(random, 0.03 * share);
      velocities[i] = random_vector(random, 3 * share);
      external[i] = random_vector(random, 0.1 * share);
    }
    if (random.uniform() < 0.2) {  // a spring of length zero
      const auto [i, j] = network.springs[random.below(network.spring_count())];
      positions[i] = positions[j];
    }
    shares.assign(network.spring_count(), 1);
    for (double& each : shares) {  // cut or fading
      if (random.uniform() < 0.2) each = 0.5 * static_cast<double>(random.below(2));
    }
    hold(random);
  }

  void put(NetworkSolver& solver) const {
    VecArray forces(external);
    solver.set_external(forces);
    for (std::uint32_t i = 0; i < rest.size(); ++i) solver.place(i, positions[i], velocities[i]);
    for (std::uint32_t s = 0; s < shares.size(); ++s) solver.set_share(s, shares[s]);
  }
  void put(Reference& reference) const {
    reference.positions = positions, reference.velocities = velocities, reference.external = external;
    reference.shares = shares;
  }

 private:
  // A third of the nodes that may move, at most ten.
  void hold(Random& random) {
    constraints.clear();
    const std::size_t count = std::min<std::size_t>((rest.size() - 1) / 3, 10);
    for (const std::uint32_t node : random_order(rest.size() - 1, random)) {
      if (constraints.size() == count) break;
      NodeConstraint c;
      c.node = node + 1;
      c.normal = normalized(random_vector(random, 1));
      c.static_friction = random.uniform(0, 2);
      c.dynamic_friction = c.static_friction * random.uniform();
      c.state = static_cast<ContactState>(random.below(3));
      c.velocity = random_vector(random, std::pow(10.0, random.uniform(-3, 1)));
      constraints.push_back(c);
    }
  }
};

}  // namespace crumble
