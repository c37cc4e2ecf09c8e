#include "baselines/bullet_network.hpp"

namespace crumble::bench {

std::unique_ptr<BulletNetwork> make_bullet_network(const SpringNetwork&, std::span<const Vec3>, double) {
  return nullptr;
}

}  // namespace crumble::bench
