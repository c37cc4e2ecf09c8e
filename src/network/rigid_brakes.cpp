// What brakes a loose fragment where it is held.
#include <array>

#include "network/rigid_frames.hpp"
#include "network/semidefinite.hpp"

namespace crumble {
namespace {

using Matrix6 = std::array<std::array<double, 6>, 6>;  // its lower triangle
using Vector6 = std::array<double, 6>;

// Of a node at r that is held: 1 and r x by components.
void add_drag(double strength, const Vec3& r, const Vec3& holder, Matrix6& a, Vector6& b) {
  const double x = strength * r.x(), y = strength * r.y(), z = strength * r.z();
  for (std::size_t axis = 0; axis < 3; ++axis) a[axis][axis] += strength;
  a[3][1] -= z, a[3][2] += y;
  a[4][0] += z, a[4][2] -= x;
  a[5][0] -= y, a[5][1] += x;
  a[3][3] += y * r.y() + z * r.z(), a[4][4] += x * r.x() + z * r.z(), a[5][5] += x * r.x() + y * r.y();
  a[4][3] -= x * r.y(), a[5][3] -= x * r.z(), a[5][4] -= y * r.z();
  const Vec3 push = strength * holder, turn = cross(r, push);
  b[0] += push.x(), b[1] += push.y(), b[2] += push.z();
  b[3] += turn.x(), b[4] += turn.y(), b[5] += turn.z();
}

void add_drag_along(double strength, const Vec3& r, const Vec3& holder, const Vec3& n, Matrix6& a, Vector6& b) {
  const Vec3 lever = cross(r, n);
  const Vector6 row{n.x(), n.y(), n.z(), lever.x(), lever.y(), lever.z()};
  const double push = strength * dot(n, holder);
  for (std::size_t i = 0; i < 6; ++i) {
    for (std::size_t k = 0; k <= i; ++k) a[i][k] += strength * row[i] * row[k];
    b[i] += push * row[i];
  }
}

}  // namespace

// (M + tau B) W+ = M W + tau (F + B w): W velocity and spin, B the brakes' drag, w the velocity of their holders. The
// drag of a node at r along n is n n^T for translation and (r x n)(r x n)^T for rotation.
void RigidFrames::slow_down(Group& m, double tau) noexcept {
  const Vec3 center = m.center;
  Matrix6 a{};
  const Inertia& inertia = m.inertia;
  for (std::size_t axis = 0; axis < 3; ++axis) a[axis][axis] = m.mass;
  a[3][3] = inertia.xx, a[4][4] = inertia.yy, a[5][5] = inertia.zz;
  a[4][3] = inertia.xy, a[5][3] = inertia.xz, a[5][4] = inertia.yz;
  const Vec3 linear = m.mass * m.velocity + tau * m.force, angular = m.momentum + tau * m.torque;
  Vector6 b{linear.x(), linear.y(), linear.z(), angular.x(), angular.y(), angular.z()};
  for (std::uint32_t k = m.first_brake; k != kNoPlace; k = brakes_[k].next) {
    const Brake& brake = brakes_[k];
    const Vec3 r = positions[brake.place] - center, &n = brake.normal;
    const double strength = tau * brake.drag;
    if (n == Vec3::Zero()) {
      add_drag(strength, r, brake.velocity, a, b);
    } else {
      add_drag_along(strength, r, brake.velocity, n, a, b);
    }
  }
  solve_semidefinite(a, b);
  m.velocity = {b[0], b[1], b[2]};
  m.center += tau * m.velocity;
  const Vec3 spin(b[3], b[4], b[5]);
  if (m.nodes > 1) m.momentum = inertia.times(spin);
  for (std::uint32_t k = m.first_brake; k != kNoPlace; k = brakes_[k].next) {
    const Brake& brake = brakes_[k];
    const Vec3 here = m.velocity + cross(spin, positions[brake.place] - center);
    const bool all = brake.normal == Vec3::Zero();
    const Vec3 moves = all ? here : Vec3(dot(here, brake.normal) * brake.normal);
    brake_work_ += tau * brake.drag * dot(brake.velocity - here, moves);
  }
}

}  // namespace crumble
