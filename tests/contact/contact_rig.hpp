// Contact alone: nodes without springs, and the test plays the solver between finding and remembering.
#pragma once

#include <vector>

#include "contact/sticks.hpp"
#include "crumble/contact/contacts.hpp"

namespace crumble {

inline constexpr double kTau = 1e-3;  // seconds
inline constexpr Friction kPaperFriction{3.0, 1.5};

inline Pose at(double x, double y, double z) {
  return {Vec3(x, y, z), Quat::Identity()};
}

inline Tool bar(double x, double y, double z) {
  return {make_bar({x, y, z}), kPaperFriction};
}

inline VecArray far_away(std::size_t n) {
  VecArray nodes(n);
  for (std::size_t i = 0; i < n; ++i) nodes.set(i, {100, 100, 100});
  return nodes;
}

struct ContactRig {
  Contacts contacts;
  VecArray positions, velocities;

  ContactRig(std::vector<Tool> tools, std::vector<Vec3> nodes, ContactRule rule = ContactRule::nearest_surface,
             std::vector<Wall> walls = {}, std::vector<std::uint8_t> fixed = {})
      : contacts(std::move(tools), std::move(walls), fixed.empty() ? std::vector<std::uint8_t>(nodes.size()) : fixed,
                 rule),
        positions(nodes),
        velocities(nodes.size()) {}

  /// Puts the tools down while the nodes are elsewhere, so that they are engaged wherever the nodes are.
  void engage(const std::vector<Pose>& poses) {
    const VecArray elsewhere = far_away(positions.size());
    for (std::size_t t = 0; t < poses.size(); ++t) contacts.move_tool(t, poses[t], kTau);
    contacts.find(0, elsewhere);
  }

  /// Stages 1 and 2.
  void touch(const std::vector<Pose>& poses) noexcept {
    for (std::size_t t = 0; t < poses.size(); ++t) contacts.move_tool(t, poses[t], kTau);
    for (std::uint32_t place = 0; place < contacts.place_count(); ++place) {
      contacts.find(place, positions);
      contacts.project(positions, velocities);
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
    for (std::size_t i = 0; i < positions.size(); ++i) {
      std::uint32_t face = 0;
      greatest = std::max(greatest,
                          -greatest_plane_distance(contacts.tools()[tool].shape, frame.to_local(positions[i]), face));
    }
    return greatest;
  }
};

}  // namespace crumble
