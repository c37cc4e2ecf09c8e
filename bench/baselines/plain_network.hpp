// The unit that all speeds are told in: the network's step as one writes it down first. Doubles, a vector per node, the
// springs in one loop, then Eqs (3) and (4) node by node; no stretch test, no contact. Always compiled at -O2.
#pragma once

#include <span>

#include "crumble/base/memory.hpp"
#include "crumble/network/coefficients.hpp"
#include "crumble/network/spring_network.hpp"

namespace crumble::bench {

class PlainNetwork {
 public:
  PlainNetwork(const SpringNetwork& network, const StepCoefficients& coefficients);
  /// Every node at `positions` (node_count), standing still.
  void place(std::span<const Vec3> positions);
  void step() noexcept;
  std::span<const Vec3> positions() const { return positions_; }

 private:
  struct Spring {
    std::uint32_t first, second;
    double stiffness, rest_length;
  };
  struct Gains {  // of one node, see StepCoefficients
    double decay, velocity_gain, drift, force_gain;
  };
  Vector<Spring> springs_;
  Vector<Gains> gains_;
  Vector<Vec3> positions_, velocities_, forces_;
};

}  // namespace crumble::bench
