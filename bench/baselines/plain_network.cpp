#include "baselines/plain_network.hpp"

#include <algorithm>

namespace crumble::bench {

PlainNetwork::PlainNetwork(const SpringNetwork& network, const StepCoefficients& coefficients)
    : velocities_(network.node_count()), forces_(network.node_count()) {
  for (std::size_t s = 0; s < network.spring_count(); ++s) {
    springs_.push_back({network.springs[s][0], network.springs[s][1], network.stiffnesses[s], network.rest_lengths[s]});
  }
  for (std::size_t i = 0; i < network.node_count(); ++i) {
    gains_.push_back(
        {coefficients.decay[i], coefficients.velocity_gain[i], coefficients.drift[i], coefficients.force_gain[i]});
  }
}

void PlainNetwork::place(std::span<const Vec3> positions) {
  positions_.assign(positions.begin(), positions.end());
  std::fill(velocities_.begin(), velocities_.end(), Vec3::Zero());
}

void PlainNetwork::step() noexcept {
  std::fill(forces_.begin(), forces_.end(), Vec3::Zero());
  for (const Spring& spring : springs_) {
    const Vec3 along = positions_[spring.second] - positions_[spring.first];
    const double length = norm(along);
    const Vec3 force = spring.stiffness * (length - spring.rest_length) / length * along;
    forces_[spring.first] += force;
    forces_[spring.second] -= force;
  }
  for (std::size_t i = 0; i < positions_.size(); ++i) {
    const Gains& gains = gains_[i];
    positions_[i] += gains.drift * velocities_[i] + gains.force_gain * forces_[i];
    velocities_[i] = gains.decay * velocities_[i] + gains.velocity_gain * forces_[i];
  }
}

}  // namespace crumble::bench
