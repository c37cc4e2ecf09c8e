// One exponential step of the network: Eqs (5), (3) and (4), with the nodes that a tool holds.
#pragma once

#include <span>

#include "crumble/network/coefficients.hpp"
#include "crumble/network/spring_network.hpp"
#include "crumble/tetmesh/node_constraint.hpp"

namespace crumble {

/// Eq (5): forces = external + springs, at the present positions. A spring shorter than the root of the smallest
/// normal number pulls nowhere.
void sum_forces(const SpringNetwork& network, NetworkState& state) noexcept;

/// Coulomb's answer for each held node, from the force on it: released when the body pulls away, stick, or slip. Writes
/// each constraint's state and reaction. A fresh or sticking node starts to slip above static_friction times the normal
/// force; a slipping one goes on until dynamic friction holds it.
void filter_contacts(std::span<NodeConstraint> constraints, VecView forces) noexcept;

/// Eqs (3) and (4) for every node; held nodes stay (stick) or slide along the surface (slip).
class ExponentialSolver {
 public:
  explicit ExponentialSolver(std::size_t node_count) : held_(node_count) {}
  /// The whole of stage 3. At most one constraint per node. No allocation.
  void solve(const SpringNetwork& network, const StepCoefficients& coefficients, NetworkState& state,
             std::span<NodeConstraint> constraints) noexcept;

 private:
  struct Held {
    Vec3 position, velocity;
  };
  std::vector<Held> held_;
};

}  // namespace crumble
