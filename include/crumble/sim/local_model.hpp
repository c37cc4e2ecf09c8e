// What the body does to a tool near where it is: a small copy of the contact, for a loop that runs faster than the
// steps. The one thread steps the body and hands the newest model over (base/latest_value.hpp), the other evaluates it
// at every pose that comes in between.
//
// Each contact is kept as the springs that join its node to the rest of the body: what they pull with now, and the
// tangent of that pull while their other ends are held (docs/contact.md). What a neighbor would give way is left out,
// so the model is stiffer than the body: the side on which a loop stays stable. Contacts are followed one by one: each
// holds no more than its friction and lets go when it would pull.
#pragma once

#include <array>
#include <cstdint>

#include "crumble/geometry/pose.hpp"
#include "crumble/sim/step_info.hpp"

namespace crumble {

/// d(force, torque) / d(translation, rotation of the tool): 6 x 6 by rows, in N/m, N, N and N m. Symmetric, never
/// positive.
using WrenchJacobian = std::array<double, 36>;

/// One node that a tool holds and that can slide or let go.
struct LocalContact {
  Vec3 arm;        // from the tool's origin to the node, m
  Vec3 normal;     // unit, from the tool into the body
  Vec3 force;      // of the springs and forces from outside on the node, N
  Vec3 inner;      // of springs to nodes of the same tool, N: turns with it; of a sliding node in `force`
  Mat3 stiffness;  // - d force / d node, N/m; symmetric, never negative
  double grip;     // the tangential force may be so many times the normal one
};

/// Of fixed size and without pointers. `wrench` + `jacobian` x (translation, rotation vector) is right to first order
/// while no contact node moves farther than `radius`; evaluate() goes on where contacts slide and let go.
struct LocalModel {
  static constexpr std::size_t kListed = 96;
  static constexpr double kReach = 5e-4;  // metres; farther out the tool meets other nodes

  Pose at;                        // of the tool (of the hand that holds it)
  Wrench wrench;                  // there: what the next step gives if the tool stays. Eq (7)'s mean is not in it
  WrenchJacobian jacobian{};      // what turning does to the arms of the forces is not in it (evaluate() has it)
  Mat3 stiffness = Mat3::Zero();  // - d force / d translation, N/m: what a servo loop has to damp
  Mat3 holding = Mat3::Zero();    // the same if no contact slid: what it will be when the tool turns back
  double radius = kReach;         // m
  double held_drag = 0;           // see Simulation::held_drag
  bool fracture = false;          // the step cut springs: a fall of the force is the signal
  std::uint32_t contacts = 0;     // in all
  std::uint32_t listed = 0;       // of these in `contact`; the others are in `rest`
  std::array<LocalContact, kListed> contact;

  // Nodes that an attachment holds, and contacts that the list has no room for: as one, by its own Jacobian.
  Wrench rest;
  WrenchJacobian rest_jacobian{};
  Vec3 rest_normal = Vec3::Zero();  // the way it presses; lets go as a whole. 0: never lets go
};

/// What the body does to the tool at `pose`: at `model.at` the model's wrench. Continuous; zero when all contacts have
/// let go, and for a pose that is not valid.
Wrench evaluate(const LocalModel& model, const Pose& pose) noexcept;

}  // namespace crumble
