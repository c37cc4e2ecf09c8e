#include "network/rigid_frames.hpp"

#include <array>
#include <cmath>

#include "crumble/geometry/pose.hpp"
#include "network/moments.hpp"
#include "network/semidefinite.hpp"

namespace crumble {

void Inertia::add(double mass, const Vec3& r) noexcept {
  const double x = mass * r.x(), y = mass * r.y(), z = mass * r.z();
  const double x2 = x * r.x(), y2 = y * r.y(), z2 = z * r.z();
  xx += y2 + z2, yy += x2 + z2, zz += x2 + y2;
  xy -= x * r.y(), xz -= x * r.z(), yz -= y * r.z();
}

Vec3 Inertia::times(const Vec3& v) const noexcept {
  return {(xx * v.x() + xy * v.y()) + xz * v.z(), (xy * v.x() + yy * v.y()) + yz * v.z(),
          (xz * v.x() + yz * v.y()) + zz * v.z()};
}

// By cofactors where that keeps its digits. One node cannot turn; two turn alike about all axes but their own, about
// which no momentum can be; more than two on one line are left to the slower way.
Inertia Inertia::inverse(std::uint32_t nodes) const noexcept {
  const double trace = (xx + yy) + zz;
  if (nodes == 1 || !(trace > 0)) return {};
  if (nodes == 2) return {2 / trace, 2 / trace, 2 / trace, 0, 0, 0};
  const double cxx = yy * zz - yz * yz, cxy = xz * yz - xy * zz, cxz = xy * yz - xz * yy;
  const double determinant = (xx * cxx + xy * cxy) + xz * cxz;
  if (determinant > 1e-6 * trace * trace * trace) {
    const double f = 1 / determinant;
    return {f * cxx, f * (xx * zz - xz * xz), f * (xx * yy - xy * xy), f * cxy, f * cxz, f * (xy * xz - xx * yz)};
  }
  std::array<std::array<double, 3>, 3> column{};
  for (std::size_t k = 0; k < 3; ++k) {
    std::array<std::array<double, 3>, 3> a{{{xx, 0, 0}, {xy, yy, 0}, {xz, yz, zz}}};
    column[k][k] = 1;
    solve_semidefinite(a, column[k]);
  }
  return {column[0][0], column[1][1], column[2][2], column[0][1], column[0][2], column[1][2]};
}

RigidFrames::RigidFrames(std::span<const double> masses)
    : positions(2 * masses.size()),
      velocities(2 * masses.size()),
      forces(2 * masses.size()),
      node_masses_(masses.begin(), masses.end()),
      place_of_(masses.size(), kNoPlace),
      group_of_(2 * masses.size()),
      masses_(2 * masses.size()) {
  nodes_.reserve(2 * masses.size());
  groups_.reserve(masses.size());
  brakes_.reserve(2 * masses.size());  // a node that slides has two
}

void RigidFrames::set(const NodeGroups& groups) noexcept {
  for (const std::uint32_t node : nodes_) {
    if (node != kNoNode) place_of_[node] = kNoPlace;
  }
  nodes_.clear();
  groups_.clear();
  for (std::size_t g = 0; g + 1 < groups.first.size(); ++g) {
    Group group;
    group.begin = static_cast<std::uint32_t>(nodes_.size());
    group.nodes = groups.first[g + 1] - groups.first[g];
    group.end = group.begin + (group.nodes + 1) / 2 * 2;
    for (std::uint32_t place = group.begin; place < group.end; ++place) {
      const bool pads = place == group.begin + group.nodes;
      const std::uint32_t node = pads ? kNoNode : groups.nodes[groups.first[g] + (place - group.begin)];
      nodes_.push_back(node);
      masses_[place] = pads ? 0 : node_masses_[node];
      group_of_[place] = static_cast<std::uint32_t>(groups_.size());
      group.mass += masses_[place];
      for (VecArray* each : {&positions, &velocities, &forces}) each->set(place, Vec3::Zero());
      if (!pads) place_of_[node] = place;
    }
    groups_.push_back(group);
  }
}

namespace {

// By twice the arc tangent of half the vector's length: no sine is needed.
Mat3 turn_by(const Vec3& angle) {
  const Vec3 half = 0.5 * angle;
  const double w = 1 / std::sqrt(1 + squared_norm(half));
  return rotation_matrix(Quat(w, w * half.x(), w * half.y(), w * half.z()));
}

}  // namespace

void RigidFrames::find_motions() noexcept {
  brakes_.clear();
  for (Group& group : groups_) find_motion(group);
}

void RigidFrames::find_motion(Group& g) noexcept {
  g.first_brake = kNoPlace;
  if (g.nodes == 1) {
    g.center = positions[g.begin], g.velocity = velocities[g.begin], g.force = forces[g.begin];
    return;
  }
  const Vec3 here = positions[g.begin];
  if (g.nodes % 2 == 1) positions.set(g.end - 1, here), forces.set(g.end - 1, Vec3::Zero());
  const Pair3 from = Pair3::all(here);
  Moments moments;
  Pair3 force, torque;
  for (std::uint32_t i = g.begin; i < g.end; i += 2) {
    const Pair3 r = Pair3::at(positions, i) - from, f = Pair3::at(forces, i);
    moments.add(load(&masses_[i]), r, Pair3::at(velocities, i));
    force = force + f;
    torque = torque + cross_of(r, f);
  }
  const Rigid rigid(moments, g.mass);
  g.center = here + rigid.center;
  g.velocity = rigid.velocity;
  g.momentum = rigid.momentum;
  g.inertia = rigid.inertia;
  g.inverse = g.inertia.inverse(g.nodes);
  g.spin = g.inverse.times(g.momentum);
  g.force = force.sums();
  g.torque = torque.sums() - cross(rigid.center, g.force);
}

Vec3 RigidFrames::rigid_velocity(std::uint32_t place) const noexcept {
  const Group& g = groups_[group_of_[place]];
  return g.velocity + cross(g.spin, positions[place] - g.center);
}

void RigidFrames::add_force(std::uint32_t place, const Vec3& force) noexcept {
  Group& g = groups_[group_of_[place]];
  forces.set(place, forces[place] + force);
  g.force += force;
  g.torque += cross(positions[place] - g.center, force);
}

void RigidFrames::brake(std::uint32_t place, double drag, const Vec3& holder_velocity, const Vec3& normal) noexcept {
  Group& g = groups_[group_of_[place]];
  brakes_.push_back({place, g.first_brake, drag, holder_velocity, normal});
  g.first_brake = static_cast<std::uint32_t>(brakes_.size() - 1);
}

void RigidFrames::split(double tau) noexcept {
  brake_work_ = 0;
  for (Group& group : groups_) split_group(group, tau);
}

// g has no sum and no moment about the center. In the turning frame it holds the centrifugal force; the Coriolis force,
// which does no work on u, is left out.
void RigidFrames::split_group(Group& g, double tau) noexcept {
  const Vec3 acceleration = g.force / g.mass;
  if (g.nodes == 1) {
    forces.set(g.begin, Vec3::Zero());
    velocities.set(g.begin, Vec3::Zero());
  } else {
    const Vec3 turning = g.inverse.times(g.torque - cross(g.spin, g.inertia.times(g.spin)));
    const Mat3 spins = cross_matrix(g.spin), pulls = cross_matrix(turning) + product(spins, spins);
    const Pair3 center = Pair3::all(g.center), velocity = Pair3::all(g.velocity), push = Pair3::all(acceleration);
    for (std::uint32_t i = g.begin; i < g.end; i += 2) {
      const Pair3 r = Pair3::at(positions, i) - center;
      (Pair3::at(forces, i) - times(load(&masses_[i]), push + times(pulls, r))).put(forces, i);
      ((Pair3::at(velocities, i) - velocity) - times(spins, r)).put(velocities, i);
    }
  }
  if (g.first_brake != kNoPlace) return slow_down(g, tau);
  g.center += tau * (g.velocity + 0.5 * tau * acceleration);
  g.velocity += tau * acceleration;
  g.momentum += tau * g.torque;
}

void RigidFrames::join(double tau) noexcept {
  for (const Group& group : groups_) join_group(group, tau);
}

// The momenta that Eqs (3) and (4) gave the rests, since no two nodes need have the same, are taken away again.
void RigidFrames::join_group(const Group& g, double tau) noexcept {
  if (g.nodes == 1) {
    positions.set(g.begin, g.center);
    velocities.set(g.begin, g.velocity);
    return;
  }
  const Vec3 here = positions[g.begin];
  if (g.nodes % 2 == 1) positions.set(g.end - 1, here), velocities.set(g.end - 1, Vec3::Zero());
  const Pair3 from = Pair3::all(here);
  Moments moments;
  for (std::uint32_t i = g.begin; i < g.end; i += 2) {
    moments.add(load(&masses_[i]), Pair3::at(positions, i) - from, Pair3::at(velocities, i));
  }
  const Rigid rest(moments, g.mass);
  const Inertia inverse = rest.inertia.inverse(g.nodes);
  const auto spin_after = [&](const Mat3& turn) { return rotate(turn, inverse.times(rotate_back(turn, g.momentum))); };
  // the spin changes as the body turns: its mean over the step, foreseen
  const Vec3 spin = inverse.times(g.momentum);
  const Mat3 turn = turn_by(0.5 * tau * (spin + spin_after(turn_by(tau * spin))));
  const Mat3 whirl =
      product(cross_matrix(spin_after(turn)), turn) - product(turn, cross_matrix(inverse.times(rest.momentum)));
  const Pair3 middle = Pair3::all(here + rest.center), center = Pair3::all(g.center);
  const Pair3 velocity = Pair3::all(g.velocity - rotate(turn, rest.velocity));
  for (std::uint32_t i = g.begin; i < g.end; i += 2) {
    const Pair3 r = Pair3::at(positions, i) - middle;
    (velocity + (times(turn, Pair3::at(velocities, i)) + times(whirl, r))).put(velocities, i);
    (center + times(turn, r)).put(positions, i);
  }
}

}  // namespace crumble
