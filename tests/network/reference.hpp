// The oracle of the network's tests: one solve(), written for reading. Doubles, node by node, one spring after the
// other in the mesh's order; no layout, no lanes, no threads.
#pragma once

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <utility>

#include "crumble/base/memory.hpp"
#include "crumble/network/solver.hpp"

namespace crumble {

inline SolverSettings settings_of(Precision precision, std::string kernel = "", double length_limit = 0,
                                  double cut_share = 0) {
  SolverSettings settings;
  settings.precision = precision;
  settings.kernel = std::move(kernel);
  settings.length_limit = length_limit;
  settings.cut_share = cut_share;
  return settings;
}

class Reference {
 public:
  Vector<Vec3> positions, velocities, external;  // by node
  Vector<double> shares;                         // by spring: 1 intact, 0 gone
  // what the last solve() found
  Vector<Vec3> forces;                // by node, N
  Vector<double> pulls;               // by node: sum of the sizes of all that pulls at it, N
  Vector<std::uint32_t> overlong;     // ascending
  std::optional<std::uint32_t> lost;  // one of the nodes that would have left the world

  Reference(const SpringNetwork& network, const StepCoefficients& coefficients, std::span<const Vec3> rest,
            const SolverSettings& settings)
      : positions(rest.begin(), rest.end()),
        velocities(rest.size(), Vec3::Zero()),
        external(velocities),
        shares(network.spring_count(), 1),
        network_(network),
        c_(coefficients),
        settings_(settings) {}

  void solve(std::span<NodeConstraint> constraints) {
    sum_forces();
    lost.reset();
    Vector<Vec3> next = positions, speed = velocities;
    for (std::uint32_t i = 0; i < positions.size(); ++i) {  // Eqs (3) and (4)
      next[i] += c_.drift[i] * velocities[i] + c_.force_gain[i] * forces[i];
      speed[i] = c_.decay[i] * velocities[i] + c_.velocity_gain[i] * forces[i];
      if (in_world(next[i]) && in_world(speed[i])) continue;
      next[i] = positions[i], speed[i] = Vec3::Zero();
      if (!lost) lost = i;
    }
    for (NodeConstraint& c : constraints) {
      filter_contact(c, forces[c.node]);
      if (c.state == ContactState::released) continue;
      next[c.node] = positions[c.node], speed[c.node] = velocities[c.node];
      if (c.state == ContactState::slip) slide(c, next[c.node], speed[c.node]);
    }
    positions = next, velocities = speed;
  }

 private:
  static bool in_world(const Vec3& v) {
    return std::abs(v.x()) <= 1000 && std::abs(v.y()) <= 1000 && std::abs(v.z()) <= 1000;
  }

  // Eq (5), gravity, and the cut test of Eq (8)
  void sum_forces() {
    forces = external;
    pulls.assign(positions.size(), 0);
    overlong.clear();
    for (std::size_t i = 0; i < pulls.size(); ++i) pulls[i] = norm(external[i]);
    for (std::uint32_t s = 0; s < network_.spring_count(); ++s) {
      const auto [i, j] = network_.springs[s];
      const Vec3 between = positions[j] - positions[i];
      const double length = norm(between), rest = network_.rest_lengths[s];
      if (length * length < 1e-37) continue;
      double stiffness = network_.stiffnesses[s] * shares[s];
      if (settings_.length_limit > 0 && shares[s] == 1 && length > settings_.length_limit * rest) {
        overlong.push_back(s);
        stiffness *= settings_.cut_share;
      }
      const Vec3 pull = (stiffness * (length - rest) / length) * between;
      forces[i] += pull, forces[j] -= pull;
      for (const std::uint32_t node : {i, j}) pulls[node] += stiffness * (length + rest);
    }
  }

  // A node that friction does not hold: it goes along the surface as far as springs and friction take it, but friction
  // never makes it overtake the surface in the other direction.
  void slide(NodeConstraint& c, Vec3& position, Vec3& velocity) const {
    const Vec3 force = forces[c.node];
    const double drift = c_.drift[c.node], gain = c_.force_gain[c.node];
    const double pressing = -dot(force, c.normal), friction = c.dynamic_friction * pressing;
    const Vec3 along = normalized(force + pressing * c.normal);
    const double surface = c_.substep * dot(c.velocity, along);
    const double loose = drift * dot(velocity, along) + gain * dot(force, along);
    Vec3 drag = -friction * along;  // it runs ahead of the surface
    if (loose - gain * friction < surface) {
      if (loose + gain * friction > surface) {  // friction is enough to take it along
        c.state = ContactState::stick;
        return;
      }
      drag = friction * along;  // the surface runs ahead of it
    }
    c.reaction = pressing * c.normal + drag;
    const Vec3 sliding = velocity - dot(velocity, c.normal) * c.normal, net = force + c.reaction;
    position += drift * sliding + gain * net;
    velocity += (c_.decay[c.node] - 1) * sliding + c_.velocity_gain[c.node] * net;
  }

  const SpringNetwork& network_;
  const StepCoefficients& c_;
  SolverSettings settings_;
};

}  // namespace crumble
