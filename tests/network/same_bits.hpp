// Two solvers that should be one.
#pragma once

#include <gtest/gtest.h>

#include <cstring>

#include "crumble/base/memory.hpp"
#include "crumble/network/solver.hpp"

namespace crumble {

inline std::uint64_t state_bits(const NetworkSolver& solver) {
  Hash hash;
  solver.add_to(hash);
  return hash.value();
}

inline std::uint64_t force_bits(const NetworkSolver& solver) {
  VecArray forces(solver.node_count());
  solver.read_forces(forces);
  Hash hash;
  for (const auto* axis : {&forces.x, &forces.y, &forces.z}) hash.add(std::span<const double>(*axis));
  return hash.value();
}

inline Vector<std::uint32_t> copied(std::span<const std::uint32_t> ids) {
  return {ids.begin(), ids.end()};
}

/// State, forces, and what the last solve() found and did.
inline testing::AssertionResult same_bits(const NetworkSolver& a, const Vector<NodeConstraint>& held_by_a,
                                          const NetworkSolver& b, const Vector<NodeConstraint>& held_by_b) {
  if (copied(a.overlong()) != copied(b.overlong())) return testing::AssertionFailure() << "other springs are overlong";
  if (a.lost_node() != b.lost_node()) return testing::AssertionFailure() << "another node is lost";
  if (state_bits(a) != state_bits(b)) return testing::AssertionFailure() << "another state";
  if (force_bits(a) != force_bits(b)) return testing::AssertionFailure() << "other forces";
  for (std::size_t k = 0; k < held_by_a.size(); ++k) {
    const NodeConstraint &c = held_by_a[k], &d = held_by_b[k];
    if (c.state != d.state || std::memcmp(c.reaction.data(), d.reaction.data(), sizeof c.reaction) != 0) {
      return testing::AssertionFailure() << "another reaction at node " << c.node;
    }
  }
  return testing::AssertionSuccess();
}

}  // namespace crumble
