#include "crumble/network/spring_network.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "crumble/base/error.hpp"
#include "crumble/base/memory.hpp"
#include "crumble/base/text.hpp"

namespace crumble {
namespace {

void check(const Material& material) {
  require_positive("material.stiffness", material.stiffness);
  require_positive("material.mass", material.mass);
  require_finite("material.damping_ratio", material.damping_ratio);
  if (material.damping_ratio < 0) {
    throw Error(Code::out_of_range,
                "material.damping_ratio must not be negative, is " + to_text(material.damping_ratio));
  }
  require_in_range("material.spring_damping", material.spring_damping, 0, 1e9);
  require_finite("material.length_limit", material.length_limit);
  if (material.length_limit <= 1) {
    throw Error(Code::out_of_range, "material.length_limit must be above 1 (else the body breaks at rest), is " +
                                        to_text(material.length_limit));
  }
}

void share_mass(const TetMesh& mesh, double mass, MassRule rule, Vector<double>& masses) {
  const auto n = static_cast<double>(mesh.node_count());
  const double body_volume = volume(mesh);
  for (std::size_t i = 0; i < mesh.node_count(); ++i) {
    masses.push_back(rule == MassRule::equal ? mass / n : mass * (mesh.node_volumes[i] / body_volume));
  }
}

// Eq (2): c_i = 2 sqrt(k_max m_i alpha^2)
void set_drags(const Material& material, SpringNetwork& network) {
  Vector<double> greatest(network.node_count(), 0);
  network.stiffness_sums.assign(network.node_count(), 0);
  for (std::size_t s = 0; s < network.spring_count(); ++s) {
    for (const std::uint32_t node : network.springs[s]) {
      greatest[node] = std::max(greatest[node], network.stiffnesses[s]);
      network.stiffness_sums[node] += network.stiffnesses[s];
    }
  }
  for (std::size_t i = 0; i < network.node_count(); ++i) {
    network.drags.push_back(2 * material.damping_ratio * std::sqrt(greatest[i] * network.masses[i]));
  }
}

}  // namespace

SpringNetwork make_network(const TetMesh& mesh, const Material& material, MassRule rule,
                           std::span<const std::uint32_t> fixed_nodes) {
  check(material);
  SpringNetwork network;
  network.springs = mesh.springs;
  for (const auto& [i, j] : mesh.springs) network.rest_lengths.push_back(norm(mesh.positions[j] - mesh.positions[i]));
  network.stiffnesses.assign(mesh.springs.size(), material.stiffness);
  network.spring_damping = material.spring_damping;
  share_mass(mesh, material.mass, rule, network.masses);
  set_drags(material, network);
  network.fixed.assign(mesh.node_count(), 0);
  for (const std::uint32_t node : fixed_nodes) {
    if (node >= mesh.node_count()) {
      throw Error(Code::out_of_range, "fixed node " + std::to_string(node) + " is not one of the " +
                                          std::to_string(mesh.node_count()) + " nodes");
    }
    network.fixed[node] = 1;
  }
  return network;
}

}  // namespace crumble
