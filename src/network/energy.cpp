#include "crumble/network/energy.hpp"

#include <cmath>

namespace crumble {

double spring_energy(const SpringNetwork& network, VecView positions, std::span<const double> stiffnesses) noexcept {
  double sum = 0;
  for (std::size_t s = 0; s < network.spring_count(); ++s) {
    const auto [i, j] = network.springs[s];
    const double stretch = norm(positions[j] - positions[i]) - network.rest_lengths[s];
    sum += 0.5 * stiffnesses[s] * stretch * stretch;
  }
  return sum;
}

double kinetic_energy(const SpringNetwork& network, VecView velocities) noexcept {
  double sum = 0;
  for (std::size_t i = 0; i < network.node_count(); ++i) {
    if (!network.fixed[i]) sum += 0.5 * network.masses[i] * squared_norm(velocities[i]);
  }
  return sum;
}

double reference_energy(const SpringNetwork& network) noexcept {
  double sum = 0;
  for (std::size_t s = 0; s < network.spring_count(); ++s) {
    sum += 0.5 * network.stiffnesses[s] * network.rest_lengths[s] * network.rest_lengths[s];
  }
  return sum;
}

}  // namespace crumble
