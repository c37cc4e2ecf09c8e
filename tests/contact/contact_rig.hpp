// Contact alone: nodes without springs, and the test plays the solver between finding and remembering.
#pragma once

#include "contact/sticks.hpp"
#include "crumble/base/memory.hpp"
#include "crumble/base/reserved_vector.hpp"
#include "crumble/base/vec_array.hpp"
#include "crumble/contact/contacts.hpp"

namespace crumble {

inline constexpr double kFar = 1e9;   // metres
inline constexpr double kTau = 1e-3;  // seconds
inline constexpr Friction kPaperFriction{3.0, 1.5};

inline Pose at(double x, double y, double z) {
  return {Vec3(x, y, z), Quat::Identity()};
}

inline Tool bar(double x, double y, double z) {
  return {make_bar({x, y, z}), kPaperFriction};
}

/// Plain arrays, searched node by node; or, with `culls` off, every search returns all nodes.
struct NodeArrays : NodeSource {
  VecArray positions, velocities;
  bool culls = true;

  NodeArrays() = default;
  explicit NodeArrays(const Vector<Vec3>& nodes) : positions(nodes), velocities(nodes.size()) {
    found_.reserve(nodes.size());
  }
  std::size_t node_count() const noexcept override { return positions.size(); }
  Vec3 position(std::uint32_t node) const noexcept override { return positions[node]; }
  Vec3 velocity(std::uint32_t node) const noexcept override { return velocities[node]; }
  void place(std::uint32_t node, const Vec3& position, const Vec3& velocity) noexcept override {
    positions.set(node, position), velocities.set(node, velocity);
  }
  std::span<const std::uint32_t> inside(const Vec3& low, const Vec3& high) noexcept override {
    return search([&](const Vec3& p) { return p.cwiseMax(low).cwiseMin(high) == p; });
  }
  std::span<const std::uint32_t> behind(const Plane& plane) noexcept override {
    return search([&](const Vec3& p) { return dot(plane.normal, p) < plane.offset; });
  }

 private:
  template <class Near>
  std::span<const std::uint32_t> search(Near&& near) noexcept {
    found_.clear();
    for (std::uint32_t i = 0; i < positions.size(); ++i) {
      if (!culls || near(positions[i])) found_.push_back(i);
    }
    return found_;
  }

  ReservedVector<std::uint32_t> found_;
};

inline NodeArrays far_away(std::size_t n) {
  return NodeArrays(Vector<Vec3>(n, {100, 100, 100}));
}

struct ContactRig {
  Contacts contacts;
  NodeArrays nodes;

  ContactRig(Vector<Tool> tools, const Vector<Vec3>& start, ContactRule rule = ContactRule::nearest_surface,
             Vector<Wall> walls = {}, Vector<std::uint8_t> fixed = {})
      : contacts(std::move(tools), std::move(walls), fixed.empty() ? Vector<std::uint8_t>(start.size()) : fixed, rule),
        nodes(start) {}

  /// Puts the tools down while the nodes are elsewhere, so that they are engaged wherever the nodes are.
  void engage(const Vector<Pose>& poses) {
    NodeArrays elsewhere = far_away(nodes.node_count());
    for (std::size_t t = 0; t < poses.size(); ++t) contacts.move_holder(t, poses[t], kTau);
    contacts.find(0, elsewhere);
  }

  /// Stages 1 and 2.
  void touch(const Vector<Pose>& poses) noexcept {
    for (std::size_t t = 0; t < poses.size(); ++t) contacts.move_holder(t, poses[t], kTau);
    for (std::uint32_t place = 0; place < contacts.place_count(); ++place) {
      contacts.find(place, nodes);
      contacts.project(nodes);
    }
  }

  /// What stage 3 decides, the same for all, and the end of the step.
  void decide(ContactState state) noexcept {
    for (NodeConstraint& c : contacts.constraints()) c.state = state;
    contacts.drop_released();
  }

  const NodeConstraint* contact_of(std::uint32_t node) const {
    for (const NodeConstraint& c : contacts.constraints()) {
      if (c.node == node) return &c;
    }
    return nullptr;
  }

  /// How deep the deepest free node is in a tool; negative when none is inside.
  double greatest_depth(std::size_t tool) const {
    const Frame frame(contacts.pose(tool));
    double greatest = -1;
    for (std::size_t i = 0; i < nodes.node_count(); ++i) {
      const Vec3 local = frame.to_local(nodes.positions[i]);
      greatest = std::max(greatest, -contacts.tools()[tool].shape->nearest(local, kFar).signed_distance);
    }
    return greatest;
  }
};

}  // namespace crumble
