// Rigid crumbs that fall on a floor and on each other: what moves the balls in the tests and the benchmark of ball
// contact. The step is that of the library for a loose fragment: forces frozen over it, x += tau v + tau^2 a / 2.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <memory>

#include "contact/ball_forces.hpp"
#include "crumble/base/memory.hpp"
#include "crumble/contact/ball_contacts.hpp"
#include "crumble/fracture/fragments.hpp"

namespace crumble {

struct Crumb {
  Vector<std::uint32_t> nodes;
  Vector<Vec3> local;  // from the center, in the crumb's frame
  double mass = 0;
  Mat3 inertia = Mat3::Zero();
  Vec3 center = Vec3::Zero(), velocity = Vec3::Zero(), momentum = Vec3::Zero();  // angular
  Quat turn = Quat::Identity();
  bool fixed = false, asleep = false;
};

struct RigSetup {
  Vector<Vec3> positions;
  Vector<std::uint32_t> labels;  // crumb of each node
  double node_mass = 5e-5, tau = 1e-3;
  Friction friction{0.5, 0.5};
  Vector<std::uint32_t> fixed_crumbs = {};
  Vector<double> radii = {};  // 2.2 mm where empty
  Vector<Edge> springs = {};  // all between crumbs are cut
};

class CrumbRig {
 public:
  explicit CrumbRig(const RigSetup& setup)
      : positions(setup.positions),
        velocities(setup.positions.size()),
        tau(setup.tau),
        labels(setup.labels),
        friction_(setup.friction),
        floor_shear_(setup.positions.size()) {
    crumbs.resize(*std::max_element(labels.begin(), labels.end()) + 1);
    for (std::uint32_t i = 0; i < labels.size(); ++i) crumbs[labels[i]].nodes.push_back(i);
    for (const std::uint32_t f : setup.fixed_crumbs) crumbs[f].fixed = true;
    for (Crumb& crumb : crumbs) shape(crumb, setup.node_mass);
    make_balls(setup);
    sync();
  }

  Vector<BallFragment> fragments() const {
    Vector<BallFragment> list;
    for (const Crumb& c : crumbs) {
      list.push_back({c.fixed ? std::numeric_limits<double>::infinity() : c.mass, c.asleep});
    }
    return list;
  }

  /// What find() asks for: all nodes take part here.
  void find() {
    VecArray at(balls->nodes().size()), speeds(balls->nodes().size());
    for (std::size_t i = 0; i < at.size(); ++i) {
      at.set(i, positions[balls->nodes()[i]]);
      speeds.set(i, velocities[balls->nodes()[i]]);
    }
    balls->find(at, speeds);
  }

  void step() {
    find();
    move();
  }

  void move() {
    Vector<Vec3> force(positions.size(), Vec3::Zero());
    for (std::size_t i = 0; i < balls->pushed().size(); ++i) force[balls->pushed()[i]] = balls->forces()[i];
    if (floor) push_from_floor(force);
    for (Crumb& crumb : crumbs) {
      if (!crumb.fixed && !crumb.asleep) move(crumb, force);
    }
    sync();
  }

  /// After crumbs were moved or given a speed by hand.
  void sync() {
    for (const Crumb& c : crumbs) {
      const Vec3 w = spin(c);
      for (std::size_t i = 0; i < c.nodes.size(); ++i) {
        const Vec3 r = c.turn * c.local[i];
        positions.set(c.nodes[i], c.center + r);
        velocities.set(c.nodes[i], c.velocity + w.cross(r));
      }
    }
  }

  double kinetic_energy() const {
    double sum = 0;
    for (const Crumb& c : crumbs) {
      sum += 0.5 * c.mass * squared_norm(c.velocity) + 0.5 * spin(c).dot(c.momentum);
    }
    return sum;
  }

  VecArray positions, velocities;  // by node
  double tau;
  Vector<std::uint32_t> labels;
  Vector<Crumb> crumbs;
  std::unique_ptr<BallContacts> balls;
  Vec3 gravity{0, -9.81, 0};
  bool floor = true;  // at y = 0: node centers stay above

 private:
  void make_balls(const RigSetup& setup) {
    const std::size_t count = labels.size();
    Vector<std::uint8_t> fixed(count), on_surface(count, 1);
    for (std::uint32_t i = 0; i < count; ++i) fixed[i] = crumbs[labels[i]].fixed;
    const Vector<double> masses(count, setup.node_mass), stiffnesses(count, 30.0), sums(count, 390.0);
    const Vector<double> radii = setup.radii.empty() ? Vector<double>(count, 0.0022) : setup.radii;
    balls = std::make_unique<BallContacts>(
        BallSetup{setup.springs, radii, masses, stiffnesses, sums, on_surface, fixed, setup.friction, tau});
    Vector<std::uint32_t> cuts;
    for (std::uint32_t s = 0; s < setup.springs.size(); ++s) {
      if (labels[setup.springs[s][0]] != labels[setup.springs[s][1]]) cuts.push_back(s);
    }
    balls->update(cuts, labels, fragments());
  }

  void shape(Crumb& crumb, double node_mass) {
    crumb.mass = node_mass * static_cast<double>(crumb.nodes.size());
    for (const std::uint32_t i : crumb.nodes) crumb.center += positions[i] / static_cast<double>(crumb.nodes.size());
    for (const std::uint32_t i : crumb.nodes) {
      const Vec3 r = positions[i] - crumb.center;
      crumb.local.push_back(r);
      crumb.inertia +=
          node_mass * ((r.squaredNorm() + 2e-6) * Mat3::Identity() - r * r.transpose());  // balls of 2.2 mm
    }
  }

  static Vec3 spin(const Crumb& c) {
    if (c.nodes.size() < 2) return Vec3::Zero();
    const Mat3 turn = c.turn.toRotationMatrix();
    return turn * c.inertia.inverse() * turn.transpose() * c.momentum;
  }

  void move(Crumb& c, const Vector<Vec3>& force) {
    Vec3 sum = c.mass * gravity, torque = Vec3::Zero();
    for (const std::uint32_t i : c.nodes) {
      sum += force[i];
      torque += (positions[i] - c.center).cross(force[i]);
    }
    const Vec3 acceleration = sum / c.mass;
    c.center += tau * (c.velocity + 0.5 * tau * acceleration);
    c.velocity += tau * acceleration;
    c.momentum += tau * torque;
    // by the spin in the middle of the step, which keeps the energy of a crumb that nothing touches
    Crumb middle = c;
    for (int iteration = 0; iteration < 3; ++iteration) middle.turn = turned(c.turn, 0.5 * tau * spin(middle));
    c.turn = turned(c.turn, tau * spin(middle));
    if (c.nodes.size() != 2) return;
    const Vec3 axis = (c.turn * c.local.back()).normalized();  // nothing stops a spin about the line of two nodes
    c.momentum -= c.momentum.dot(axis) * axis;
  }

  static Quat turned(const Quat& turn, const Vec3& angle) {
    const double size = angle.norm();
    return size > 0 ? (Quat(Eigen::AngleAxisd(size, angle / size)) * turn).normalized() : turn;
  }

  // A pair of the node with the floor below it, by the library's own law: the test is of the pile, not of the floor.
  void push_from_floor(Vector<Vec3>& force) {
    BallBlock block{};
    for (const Crumb& c : crumbs) {
      double low = 0;
      for (const std::uint32_t i : c.nodes) low += positions[i].y() < 0;
      for (const std::uint32_t i : c.nodes) {
        if (positions[i].y() >= 0) {
          floor_shear_.set(i, Vec3::Zero());
          continue;
        }
        block.stiffness[0] = 0.25 * c.mass / (tau * tau) / low;
        block.reach[0] = 1;
        block.x[0] = block.z[0] = 0, block.y[0] = 1 + positions[i].y();
        block.vx[0] = velocities.x[i], block.vy[0] = velocities.y[i], block.vz[0] = velocities.z[i];
        block.shear_x[0] = floor_shear_.x[i], block.shear_y[0] = floor_shear_.y[i],
        block.shear_z[0] = floor_shear_.z[i];
        baseline_ball_law()(block, 1, friction_, tau);
        floor_shear_.set(i, {block.shear_x[0], block.shear_y[0], block.shear_z[0]});
        force[i] += Vec3(block.fx[0], block.fy[0], block.fz[0]);
      }
    }
  }

  Friction friction_;
  VecArray floor_shear_;
};

}  // namespace crumble
