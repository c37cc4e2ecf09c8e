// The smallest network: a fixed node at the origin and a free one on the x axis, with a spring between them.
#pragma once

#include "crumble/network/solver.hpp"

namespace crumble {

struct TwoNodes {
  SpringNetwork network;
  NetworkState state;

  TwoNodes(double mass, double drag, double stiffness, double rest_length) {
    network.springs = {{0, 1}};
    network.rest_lengths = {rest_length};
    network.stiffnesses = {stiffness};
    network.masses = {mass, mass};
    network.drags = {drag, drag};
    network.stiffness_sums = {stiffness, stiffness};
    network.fixed = {1, 0};
    state.positions = state.velocities = state.forces = state.external = VecArray(2);
    state.positions.x[1] = rest_length;
    state.stiffnesses = {stiffness};
  }
};

}  // namespace crumble
