// The smallest network: a fixed node at the origin and a free one on the x axis, with a spring between them.
#pragma once

#include "crumble/base/memory.hpp"
#include "crumble/network/solver.hpp"

namespace crumble {

struct TwoNodes {
  SpringNetwork network;
  Vector<Vec3> rest;

  TwoNodes(double mass, double drag, double stiffness, double rest_length) {
    network.springs = {{0, 1}};
    network.rest_lengths = {rest_length};
    network.stiffnesses = {stiffness};
    network.masses = {mass, mass};
    network.drags = {drag, drag};
    network.stiffness_sums = {stiffness, stiffness};
    network.fixed = {1, 0};
    rest = {Vec3::Zero(), {rest_length, 0, 0}};
  }
  std::unique_ptr<NetworkSolver> solver(double tau, TimeStepPolicy policy) const {
    return NetworkSolver::make(network, make_coefficients(network, tau, policy), rest, {});
  }
};

/// Forces by node, worked out anew.
inline VecArray forces_of(const NetworkSolver& solver) {
  VecArray forces(solver.node_count());
  solver.read_forces(forces);
  return forces;
}

}  // namespace crumble
