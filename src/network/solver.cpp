#include "crumble/network/solver.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace crumble {

void sum_forces(const SpringNetwork& network, NetworkState& state) noexcept {
  std::copy(state.external.x.begin(), state.external.x.end(), state.forces.x.begin());
  std::copy(state.external.y.begin(), state.external.y.end(), state.forces.y.begin());
  std::copy(state.external.z.begin(), state.external.z.end(), state.forces.z.begin());
  const double *x = state.positions.x.data(), *y = state.positions.y.data(), *z = state.positions.z.data();
  double *fx = state.forces.x.data(), *fy = state.forces.y.data(), *fz = state.forces.z.data();
  for (std::size_t s = 0; s < network.spring_count(); ++s) {
    if (state.stiffnesses[s] == 0) continue;
    const auto [i, j] = network.springs[s];
    const double dx = x[j] - x[i], dy = y[j] - y[i], dz = z[j] - z[i];
    const double squared = (dx * dx + dy * dy) + dz * dz;
    if (squared < std::numeric_limits<double>::min()) continue;
    const double length = std::sqrt(squared);
    const double pull = state.stiffnesses[s] * (length - network.rest_lengths[s]) / length;
    fx[i] += pull * dx, fy[i] += pull * dy, fz[i] += pull * dz;
    fx[j] -= pull * dx, fy[j] -= pull * dy, fz[j] -= pull * dz;
  }
}

void filter_contacts(std::span<NodeConstraint> constraints, VecView forces) noexcept {
  for (NodeConstraint& c : constraints) {
    const Vec3 force = forces[c.node];
    const double pressing = -dot(force, c.normal);
    if (!(pressing > 0)) {
      c.state = ContactState::released;
      c.reaction = Vec3::Zero();
      continue;
    }
    const Vec3 along = force + pressing * c.normal;
    const double tangential = norm(along);
    const double holding = c.state == ContactState::slip ? c.dynamic_friction : c.static_friction;
    if (tangential <= holding * pressing) {
      c.state = ContactState::stick;
      c.reaction = -force;
    } else {
      c.state = ContactState::slip;
      c.reaction = pressing * c.normal - (c.dynamic_friction * pressing / tangential) * along;
    }
  }
}

namespace {

// Velocities that only matter as slow denormal arithmetic become 0: there is no flush-to-zero mode to rely on
// everywhere.
double flushed(double v) {
  return std::abs(v) < 1e-100 ? 0 : v;
}

void advance(const StepCoefficients& c, std::vector<double>& x, std::vector<double>& v, const std::vector<double>& f) {
  for (std::size_t i = 0; i < x.size(); ++i) {
    x[i] += c.drift[i] * v[i] + c.force_gain[i] * f[i];
    v[i] = flushed(c.decay[i] * v[i] + c.velocity_gain[i] * f[i]);
  }
}

// Eqs (3) and (4) along the surface: where a node that slides under `reaction` gets to.
void slide(const StepCoefficients& c, const NodeConstraint& held, const Vec3& force, Vec3& position, Vec3& velocity) {
  const Vec3 net = force + held.reaction;  // tangential
  const double across = dot(velocity, held.normal);
  const Vec3 sliding = velocity - across * held.normal;
  position += c.drift[held.node] * sliding + c.force_gain[held.node] * net;
  velocity = (c.decay[held.node] * sliding + c.velocity_gain[held.node] * net) + across * held.normal;
}

// Friction opposes sliding past the surface, which is not always the way the springs pull: a surface that moves that
// way too, faster than the node could slide, carries the node (it sticks, at the edge of the cone), and one that is
// faster still drags it on.
void oppose_sliding(const StepCoefficients& c, NodeConstraint& held, const Vec3& force, const Vec3& velocity) {
  const double pressing = -dot(force, held.normal);
  const Vec3 along = normalized(force + pressing * held.normal);
  const double friction = held.dynamic_friction * pressing;
  const double surface = c.substep * dot(held.velocity, along);
  const double loose = c.drift[held.node] * dot(velocity, along) + c.force_gain[held.node] * dot(force, along);
  const double reach = c.force_gain[held.node] * friction;
  if (loose - reach >= surface) return;
  if (loose + reach <= surface) {
    held.reaction = pressing * held.normal + friction * along;
  } else {
    held.state = ContactState::stick;
  }
}

}  // namespace

void ExponentialSolver::solve(const SpringNetwork& network, const StepCoefficients& coefficients, NetworkState& state,
                              std::span<NodeConstraint> constraints) noexcept {
  sum_forces(network, state);
  filter_contacts(constraints, state.forces);

  // where the held nodes go is worked out before the pass over all nodes and written after it
  for (std::size_t k = 0; k < constraints.size(); ++k) {
    NodeConstraint& c = constraints[k];
    const Vec3 force = state.forces[c.node];
    held_[k] = {state.positions[c.node], state.velocities[c.node]};
    if (c.state == ContactState::slip) oppose_sliding(coefficients, c, force, held_[k].velocity);
    if (c.state == ContactState::slip) slide(coefficients, c, force, held_[k].position, held_[k].velocity);
  }
  advance(coefficients, state.positions.x, state.velocities.x, state.forces.x);
  advance(coefficients, state.positions.y, state.velocities.y, state.forces.y);
  advance(coefficients, state.positions.z, state.velocities.z, state.forces.z);
  for (std::size_t k = 0; k < constraints.size(); ++k) {
    if (constraints[k].state == ContactState::released) continue;
    state.positions.set(constraints[k].node, held_[k].position);
    state.velocities.set(constraints[k].node, held_[k].velocity);
  }
}

}  // namespace crumble
