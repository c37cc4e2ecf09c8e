// The exact linear stability boundary of Eqs (3) and (4), for reports and tests; the solver relies on the energy
// theorem instead (docs/numerics.md).
#pragma once

#include "crumble/network/spring_network.hpp"

namespace crumble {

/// For a mode f = -lambda x with drag c and gamma = c tau / m: the update is stable while lambda tau / c is below this.
double stability_limit(double gamma);

/// Greatest eigenvalue of the network's stiffness matrix at rest, N/m, by power iteration to 1e-6.
double largest_eigenvalue(const SpringNetwork& network, std::span<const Vec3> rest_positions);

}  // namespace crumble
