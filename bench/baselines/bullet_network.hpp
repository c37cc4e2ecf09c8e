// The same network as a soft body of the Bullet physics engine, the fastest of the peers that Debian packages: its
// nodes with their masses, a link for each spring, one position iteration, no gravity, no collision. Links are
// constraints, so how stiff the body is depends on iterations and time step: the time is comparable, the motion is not.
#pragma once

#include <memory>
#include <span>

#include "crumble/network/spring_network.hpp"

namespace crumble::bench {

class BulletNetwork {
 public:
  virtual ~BulletNetwork() = default;
  /// Every node at `positions` (node_count), standing still.
  virtual void place(std::span<const Vec3> positions) = 0;
  virtual void step() = 0;
};

/// Nothing in a build that found no Bullet. `rest` (node_count); `tau` in seconds.
std::unique_ptr<BulletNetwork> make_bullet_network(const SpringNetwork& network, std::span<const Vec3> rest,
                                                   double tau);

}  // namespace crumble::bench
