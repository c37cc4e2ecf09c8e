#include "baselines/bullet_network.hpp"

#include <BulletSoftBody/btSoftBody.h>

#include "crumble/base/memory.hpp"

namespace crumble::bench {
namespace {

btVector3 to_bullet(const Vec3& v) {
  return {static_cast<btScalar>(v.x()), static_cast<btScalar>(v.y()), static_cast<btScalar>(v.z())};
}

class SoftBody : public BulletNetwork {
 public:
  SoftBody(const SpringNetwork& network, std::span<const Vec3> rest, double tau) : tau_(static_cast<btScalar>(tau)) {
    world_.m_gravity = {0, 0, 0};
    Vector<btVector3> nodes;
    Vector<btScalar> masses;
    for (std::size_t i = 0; i < network.node_count(); ++i) {
      nodes.push_back(to_bullet(rest[i]));
      masses.push_back(network.fixed[i] ? 0 : static_cast<btScalar>(network.masses[i]));
    }
    body_ = std::make_unique<btSoftBody>(&world_, static_cast<int>(nodes.size()), nodes.data(), masses.data());
    for (const auto& [i, j] : network.springs) body_->appendLink(static_cast<int>(i), static_cast<int>(j));
    body_->m_cfg.piterations = 1;
    body_->m_cfg.collisions = 0;
    body_->updateConstants();
  }

  void place(std::span<const Vec3> positions) override {
    for (int i = 0; i < body_->m_nodes.size(); ++i) {
      btSoftBody::Node& node = body_->m_nodes[i];
      node.m_x = node.m_q = to_bullet(positions[static_cast<std::size_t>(i)]);
      node.m_v = node.m_vn = node.m_f = {0, 0, 0};
    }
  }

  // What btSoftRigidDynamicsWorld does to each body in a step, without the world around it.
  void step() override {
    body_->predictMotion(tau_);
    body_->solveConstraints();
    body_->integrateMotion();
  }

 private:
  btSoftBodyWorldInfo world_;
  std::unique_ptr<btSoftBody> body_;
  btScalar tau_;
};

}  // namespace

std::unique_ptr<BulletNetwork> make_bullet_network(const SpringNetwork& network, std::span<const Vec3> rest,
                                                   double tau) {
  return std::make_unique<SoftBody>(network, rest, tau);
}

}  // namespace crumble::bench
