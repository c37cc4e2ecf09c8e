// The spring-damper network of a body: what never changes while it is simulated.
#pragma once

#include <cstdint>
#include <span>

#include "crumble/base/memory.hpp"
#include "crumble/tetmesh/tet_mesh.hpp"

namespace crumble {

/// What the body is made of. Defaults: the paper's best parameters (Table 1) and its 30 g cube.
struct Material {
  double stiffness = 30;      // k of every spring, N/m; > 0
  double damping_ratio = 30;  // alpha of Eq (2); >= 0
  double length_limit = 1.3;  // l_p of Eq (8): a spring is cut when longer than l_p times its rest length; > 1
  double mass = 0.03;         // of the whole body, kg; > 0
  double spring_damping = 0;  // of a damper along each spring (paper, Fig 2f), N s/m; >= 0
};

/// How the body's mass is shared out among its nodes.
enum class MassRule : std::uint8_t {
  lumped = 0,  // by the volume that surrounds each node
  equal = 1,   // the same for all: the paper's reading
};

struct SpringNetwork {
  Vector<Edge> springs;           // node indices (spring_count)
  Vector<double> rest_lengths;    // l0, metres (spring_count)
  Vector<double> stiffnesses;     // k of the unbroken body, N/m (spring_count)
  Vector<double> masses;          // m_i, kg (node_count)
  Vector<double> drags;           // c_i of Eq (2), N s/m (node_count)
  Vector<double> stiffness_sums;  // D_i, sum of k over the node's springs, N/m (node_count)
  double spring_damping = 0;      // of the damper along each spring, N s/m
  Vector<std::uint8_t> fixed;     // 1: never moves (node_count)

  std::size_t node_count() const { return masses.size(); }
  std::size_t spring_count() const { return springs.size(); }
};

/// Throws Error naming the field: invalid_value, out_of_range.
SpringNetwork make_network(const TetMesh& mesh, const Material& material, MassRule rule,
                           std::span<const std::uint32_t> fixed_nodes);

}  // namespace crumble
