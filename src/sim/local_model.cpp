// A spring from contact node i to j, of stiffness k, length l, rest length l0 and unit vector e from i to j, pulls at i
// with f = k (l - l0) e. With j held,
//     - df/dx_i = k [ e e^T + (1 - l0/l) (I - e e^T) ].
// The second term is negative in a compressed spring: pushed sideways it gives way. It is left out there, which
// errs to the stiff side and keeps every tangent, and so every sum of tangents, from being negative.
//
// The node of a tool that moves by t and turns by w goes by G (t, w) = t + w x a, a being its arm; a force on it has
// the wrench G^T f. So a contact of tangent K adds - G^T K G to the Jacobian, which is symmetric and never positive.
#include "crumble/sim/local_model.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "crumble/sim/simulation.hpp"
#include "crumble/tetmesh/spring_graph.hpp"

namespace crumble {
namespace {

// What the tool gets from a node on which all else pulls with `force`: nothing adheres, and friction holds up to the
// cone.
Vec3 hold(const Vec3& force, const Vec3& normal, double grip) noexcept {
  const double pressing = -dot(force, normal);
  if (!(pressing > 0)) return Vec3::Zero();
  const Vec3 along = force + pressing * normal;
  const double tangential = norm(along), most = grip * pressing;
  return tangential <= most ? force : Vec3((most / tangential) * along - pressing * normal);
}

void add(Wrench& sum, const Vec3& arm, const Vec3& force) noexcept {
  sum.force += force;
  sum.torque += cross(arm, force);
}

void add_contact(WrenchJacobian& sum, const Vec3& arm, const Mat3& stiffness) noexcept {
  for (int column = 0; column < 6; ++column) {
    const Vec3 axis = Vec3::Unit(column % 3);
    const Vec3 force = rotate(stiffness, column < 3 ? axis : cross(axis, arm));
    const Vec3 torque = cross(arm, force);
    for (int row = 0; row < 3; ++row) {
      sum[static_cast<std::size_t>(6 * row + column)] -= force[row];
      sum[static_cast<std::size_t>(6 * (row + 3) + column)] -= torque[row];
    }
  }
}

Wrench apply(const WrenchJacobian& jacobian, const Vec3& translation, const Vec3& rotation) noexcept {
  Wrench out;
  for (int row = 0; row < 6; ++row) {
    const double* r = jacobian.data() + 6 * row;
    const double value = dot({r[0], r[1], r[2]}, translation) + dot({r[3], r[4], r[5]}, rotation);
    (row < 3 ? out.force : out.torque)[row % 3] = value;
  }
  return out;
}

// The turn from a to b; as a rotation vector right to third order.
Quat turn_between(const Quat& a, const Quat& b) noexcept {
  return multiply(b, Quat(a.w(), -a.x(), -a.y(), -a.z()));
}
Vec3 rotation_vector(const Quat& turn) noexcept {
  return (turn.w() < 0 ? -2 : 2) * Vec3(turn.x(), turn.y(), turn.z());
}

// How far a node may be moved, whichever way, before it lets go or a sticking one begins to slide: the shortest that
// the tangent allows.
double free_way(const LocalContact& c, const Vec3& force, bool sticks) noexcept {
  const double pressing = -dot(force, c.normal);
  const double slope = norm(rotate(c.stiffness, c.normal));
  const double release = slope > 0 ? pressing / slope : LocalModel::kReach;
  if (!sticks) return release;
  const double across = (c.stiffness(0, 0) + c.stiffness(1, 1)) + c.stiffness(2, 2) + c.grip * slope;
  const double margin = c.grip * pressing - norm(force + pressing * c.normal);
  return across > 0 ? std::min(release, std::max(margin, 0.0) / across) : release;
}

void add_outer(Mat3& sum, double factor, const Vec3& v) noexcept {
  for (int axis = 0; axis < 3; ++axis) sum.col(axis) += (factor * v[axis]) * v;
}

bool slides(const NodeConstraint& c) noexcept {
  return c.state == ContactState::slip || (c.state != ContactState::attached && c.static_friction == 0);
}

// A spring between two nodes of one tool, of tangent along way way^T + across I: two that stick go together, but one
// that slides is moved only along its normal. With one that sticks, that is exact; two that slide count for both.
void add_relative(Mat3& sum, const NodeConstraint& c, const NodeConstraint& other, const Vec3& way, double along,
                  double across) noexcept {
  if (!slides(other)) return;
  const Vec3& n = other.normal;
  if (slides(c)) {
    const Vec3 apart = c.normal - dot(c.normal, n) * n;
    const double pull = dot(way, apart);
    add_outer(sum, along * (pull * pull) + across * squared_norm(apart), c.normal);
  } else {
    add_outer(sum, along, way - dot(way, n) * n);
    add_outer(sum, -across, n);
    for (int axis = 0; axis < 3; ++axis) sum(axis, axis) += across;
  }
}

void keep(LocalModel& model, const LocalContact& c, const Vec3& force, bool lets_go) noexcept {
  ++model.contacts;
  add(model.wrench, c.arm, force);
  add_contact(model.jacobian, c.arm, c.stiffness);
  model.stiffness += c.stiffness;
  if (lets_go && model.listed < LocalModel::kListed) {
    model.contact[model.listed++] = c;
    return;
  }
  add(model.rest, c.arm, force);
  add_contact(model.rest_jacobian, c.arm, c.stiffness);
  if (lets_go) model.rest_normal -= dot(force, c.normal) * c.normal;
}

}  // namespace

Wrench evaluate(const LocalModel& model, const Pose& pose) noexcept {
  if (!is_valid(pose)) return {};
  const Pose now = renormalized(pose);
  const Quat turn = turn_between(model.at.orientation, now.orientation);
  const Mat3 rotation = rotation_matrix(turn);
  const Vec3 shift = now.position - model.at.position;

  Wrench sum = apply(model.rest_jacobian, shift, rotation_vector(turn));
  sum.force += model.rest.force, sum.torque += model.rest.torque;
  const bool presses = dot(sum.force, rotate(rotation, model.rest_normal)) < 0;
  if (!presses && squared_norm(model.rest_normal) > 0) sum = {};

  for (std::uint32_t k = 0; k < model.listed; ++k) {
    const LocalContact& c = model.contact[k];
    const Vec3 arm = rotate(rotation, c.arm);
    const Vec3 outer = c.force - rotate(c.stiffness, shift + (arm - c.arm));
    add(sum, arm, hold(outer + rotate(rotation, c.inner), rotate(rotation, c.normal), c.grip));
  }
  return sum;
}

LocalModel Simulation::local_model(std::size_t tool) const noexcept {
  LocalModel model;
  model.at = contacts_.pose(tool);
  if (info_.status != Code{}) return model;
  model.fracture = info_.new_cuts > 0;
  model.held_drag = held_drag(tool);
  const std::span<const NodeConstraint> held = contacts_.constraints();
  for (std::uint32_t k = 0; k < held.size(); ++k) {
    if (held[k].holder == tool) marks_[held[k].node] = k + 1;
  }
  for (const NodeConstraint& c : held) {
    if (c.holder == tool) add_to_model(model, c);
  }
  for (const NodeConstraint& c : held) marks_[c.node] = 0;
  return model;
}

// The contact as the next step will find it, which decides from the force whether it goes on, sticks or slides.
void Simulation::add_to_model(LocalModel& model, const NodeConstraint& c) const noexcept {
  LocalContact contact = springs_of_contact(c);
  contact.arm = solver_->position(c.node) - model.at.position;
  const Vec3 pull = contact.force + contact.inner;
  const Mat3 holding = contact.stiffness;
  if (c.state == ContactState::attached) return model.holding += holding, keep(model, contact, pull, false);
  const double pressing = -dot(pull, c.normal);
  if (!(pressing > 0)) return;
  model.holding += holding;
  const bool slides = norm(pull + pressing * c.normal) > contact.grip * pressing;
  if (slides) {  // only the normal moves it
    contact.grip = c.dynamic_friction;
    contact.force = pull;
    contact.inner = Vec3::Zero();
    const double along_normal = dot(c.normal, rotate(contact.stiffness, c.normal));
    for (int axis = 0; axis < 3; ++axis) contact.stiffness.col(axis) = (along_normal * c.normal[axis]) * c.normal;
  }
  model.radius = std::min(model.radius, free_way(contact, pull, !slides));
  keep(model, contact, hold(pull, c.normal, contact.grip), true);
}

// Of the node where it is now; the arm is left to the caller.
LocalContact Simulation::springs_of_contact(const NodeConstraint& c) const noexcept {
  const SpringGraph& graph = fragments_.graph();
  LocalContact contact{Vec3::Zero(),      c.normal,
                       external_[c.node], Vec3::Zero(),
                       Mat3::Zero(),      c.state == ContactState::slip ? c.dynamic_friction : c.static_friction};
  if (balls_) {  // what presses it from inside the body, as of the last step
    const std::span<const std::uint32_t> pushed = balls_->pushed();
    const auto at = std::find(pushed.begin(), pushed.end(), c.node);
    if (at != pushed.end()) contact.force += balls_->forces()[static_cast<std::size_t>(at - pushed.begin())];
  }
  const Vec3 here = solver_->position(c.node);
  const std::span<const std::uint32_t> neighbors = graph.neighbors_of(c.node);
  for (std::size_t n = 0; n < neighbors.size(); ++n) {
    const std::uint32_t spring = graph.springs_of(c.node)[n];
    const Vec3 way = solver_->position(neighbors[n]) - here;
    const double squared_length = squared_norm(way), stiffness = stiffnesses_[spring];
    if (squared_length < std::numeric_limits<double>::min()) continue;
    const double length = std::sqrt(squared_length);
    const double taut = 1 - network_.rest_lengths[spring] / length;
    const double across = stiffness * std::max(taut, 0.0), along = (stiffness - across) / squared_length;
    const std::uint32_t mark = marks_[neighbors[n]];
    (mark ? contact.inner : contact.force) += (stiffness * taut) * way;
    if (mark) {
      add_relative(contact.stiffness, c, contacts_.constraints()[mark - 1], way, along, across);
    } else {
      add_outer(contact.stiffness, along, way);
      for (int axis = 0; axis < 3; ++axis) contact.stiffness(axis, axis) += across;
    }
  }
  return contact;
}

double Simulation::held_drag(std::size_t tool) const noexcept {
  double sum = 0;
  for (const NodeConstraint& c : contacts_.constraints()) {
    if (c.holder == tool) sum += coefficients_.drags[c.node];
  }
  return sum;
}

}  // namespace crumble
