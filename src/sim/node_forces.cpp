// Forces that the host puts on nodes: kept until changed, part of the state, and to the solver the same as weight.
#include <algorithm>
#include <cmath>
#include <string>

#include "crumble/base/memory.hpp"
#include "crumble/base/text.hpp"
#include "crumble/sim/simulation.hpp"

namespace crumble {
namespace {

constexpr double kMostForce = 1e12;  // N, along an axis: sums and products of forces stay numbers

void require_force(std::uint32_t node, const Vec3& force) {
  if (!is_finite(force)) throw Error(Code::invalid_value, "force of node " + std::to_string(node) + " is not finite");
  for (int axis = 0; axis < 3; ++axis) {
    if (std::abs(force[axis]) <= kMostForce) continue;
    throw Error(Code::out_of_range, "force of node " + std::to_string(node) + " is " + to_text(force[axis]) +
                                        " N, at most " + to_text(kMostForce) + " along an axis is allowed");
  }
}

}  // namespace

void Simulation::set_node_force(std::uint32_t node, const Vec3& force) {
  if (node >= network_.node_count()) {
    throw Error(Code::out_of_range, "node is " + std::to_string(node) + ", there are " +
                                        std::to_string(network_.node_count()) + " of them");
  }
  require_force(node, force);
  node_forces_.set(node, force + Vec3::Zero());  // no -0, which would hash otherwise
  apply_node_forces();
}

void Simulation::set_node_forces(VecView forces) {
  if (forces.size() != network_.node_count()) {
    throw Error(Code::out_of_range, "forces has " + std::to_string(forces.size()) + " rows, there are " +
                                        std::to_string(network_.node_count()) + " nodes");
  }
  for (std::uint32_t node = 0; node < forces.size(); ++node) require_force(node, forces[node]);
  for (std::size_t node = 0; node < forces.size(); ++node) node_forces_.set(node, forces[node] + Vec3::Zero());
  apply_node_forces();
}

bool Simulation::has_node_forces() const noexcept {
  const auto any = [](const Vector<double>& axis) {
    return std::any_of(axis.begin(), axis.end(), [](double force) { return force != 0; });
  };
  return any(node_forces_.x) || any(node_forces_.y) || any(node_forces_.z);
}

void Simulation::clear_node_forces() noexcept {
  for (Vector<double>* axis : {&node_forces_.x, &node_forces_.y, &node_forces_.z}) {
    std::fill(axis->begin(), axis->end(), 0.0);
  }
  apply_node_forces();
}

// Eq (5) sees them and gravity as a constant force on each node.
void Simulation::apply_node_forces() noexcept {
  for (std::size_t node = 0; node < network_.node_count(); ++node) {
    external_.set(node, network_.masses[node] * def_.gravity + node_forces_[node]);
  }
  solver_->set_external(external_);
}

}  // namespace crumble
