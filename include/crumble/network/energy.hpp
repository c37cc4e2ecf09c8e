// Where the energy is, and where it went.
#pragma once

#include <span>

#include "crumble/base/vec_array.hpp"
#include "crumble/network/spring_network.hpp"

namespace crumble {

/// Sum of k/2 (length - rest length)^2 over the springs, with `stiffnesses` in force (spring_count, N/m), J.
double spring_energy(const SpringNetwork& network, VecView positions, std::span<const double> stiffnesses) noexcept;
/// Sum of m/2 v^2 over the nodes that may move, J.
double kinetic_energy(const SpringNetwork& network, VecView velocities) noexcept;
/// Sum of k/2 l0^2 over all springs, J: the scale against which rounding is judged.
double reference_energy(const SpringNetwork& network) noexcept;

/// Sums since the start, J. stored = tool_work + external_work - dissipated - cut.
struct EnergyLedger {
  double stored = 0;         // springs + kinetic, now
  double tool_work = 0;      // done by tools and walls on the body: projection and reaction
  double external_work = 0;  // gravity, node forces, and fragments that push each other
  double dissipated = 0;     // by drag
  double cut = 0;            // left with the cut springs
  /// Greatest growth of the solve stage alone in one substep, over stored + reference energy: the audit of the theorem.
  double gain_max_relative = 0;
};

}  // namespace crumble
