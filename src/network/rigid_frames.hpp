// Drag in the frame of a fragment: Eqs (1) to (4) for what is left of a node's motion when that of its fragment, taken
// as a rigid body, is subtracted.
//
// A loose fragment moves by its momentum and its angular momentum, and no drag touches these. The rest u of a node's
// velocity, v = V + w x r + u, and the rest g of the force on it go through Eqs (3) and (4) as they always do, in the
// kernels. What these have moved is then put where the rigid body got to, by a translation and a finite rotation of the
// whole fragment, which change no spring's length and so no energy (docs/numerics.md has the theorem).
//
// Where a fragment is held, by a tool, a wall or an attachment, the held node has a rest u too, and its drag brakes the
// fragment. These brakes are worked out implicitly, all of a fragment's at once.
#pragma once

#include <cstdint>
#include <span>

#include "crumble/base/memory.hpp"
#include "crumble/base/reserved_vector.hpp"
#include "crumble/base/vec_array.hpp"
#include "crumble/network/solver.hpp"

namespace crumble {

/// About the center of mass, in scene axes, kg m^2. Its inverse is held in the same way.
struct Inertia {
  double xx = 0, yy = 0, zz = 0, xy = 0, xz = 0, yz = 0;

  void add(double mass, const Vec3& r) noexcept;
  Vec3 times(const Vec3& v) const noexcept;
  /// Of a body of `nodes` nodes; directions about which it has none get zero.
  Inertia inverse(std::uint32_t nodes) const noexcept;
};

class RigidFrames {
 public:
  RigidFrames() = default;
  explicit RigidFrames(std::span<const double> masses);

  void set(const NodeGroups& groups) noexcept;
  /// Of the nodes; set() has to follow.
  void swap_masses(RigidFrames& other) noexcept { node_masses_.swap(other.node_masses_); }
  bool empty() const noexcept { return groups_.empty(); }
  /// Nodes group by group; a node's index in here is its place. kNoNode where a group of odd size is made even.
  std::span<const std::uint32_t> nodes() const noexcept { return nodes_; }
  std::uint32_t place_of(std::uint32_t node) const noexcept { return place_of_[node]; }  // kNoPlace: in no group
  static constexpr std::uint32_t kNoPlace = 0xffffffffu, kNoNode = 0xffffffffu;

  /// By place. The caller fills in what each call reads and fetches what it writes.
  VecArray positions, velocities, forces;

  /// Reads all three, forces without drag: how each group moves.
  void find_motions() noexcept;
  /// Of the group's rigid body at a node, after find_motions().
  Vec3 rigid_velocity(std::uint32_t place) const noexcept;
  /// A holder's force on a node, on top of what find_motions() has read.
  void add_force(std::uint32_t place, const Vec3& force) noexcept;
  /// The node goes with its holder, and the drag of it brakes its group: along the unit vector `normal`, or in all
  /// directions where that is zero.
  void brake(std::uint32_t place, double drag, const Vec3& holder_velocity, const Vec3& normal) noexcept;
  /// Velocities become u and forces become g.
  void split(double tau) noexcept;
  /// Positions and velocities that Eqs (3) and (4) left become those after the step.
  void join(double tau) noexcept;
  /// What holders did to the groups through the brakes in the last split(), J.
  double brake_work() const noexcept { return brake_work_; }

 private:
  struct Group {
    std::uint32_t begin = 0, end = 0;  // places; an even number
    std::uint32_t nodes = 0;
    double mass = 0;
    Vec3 center = Vec3::Zero(), velocity = Vec3::Zero();
    Vec3 spin = Vec3::Zero(), momentum = Vec3::Zero();  // rad/s; angular, kg m^2/s
    Vec3 force = Vec3::Zero(), torque = Vec3::Zero();
    Inertia inertia, inverse;
    std::uint32_t first_brake = kNoPlace;
  };
  struct Brake {
    std::uint32_t place, next;
    double drag;
    Vec3 velocity, normal;
  };

  void find_motion(Group& group) noexcept;
  void split_group(Group& group, double tau) noexcept;
  void slow_down(Group& group, double tau) noexcept;
  void join_group(const Group& group, double tau) noexcept;

  Vector<double> node_masses_;
  ReservedVector<std::uint32_t> nodes_;
  Vector<std::uint32_t> place_of_, group_of_;  // by node, by place
  Vector<double> masses_;                      // by place; 0 where there is no node
  ReservedVector<Group> groups_;
  ReservedVector<Brake> brakes_;
  double brake_work_ = 0;
};

}  // namespace crumble
