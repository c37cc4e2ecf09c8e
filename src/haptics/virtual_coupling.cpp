#include "crumble/haptics/virtual_coupling.hpp"

#include <algorithm>

#include "crumble/base/error.hpp"

namespace crumble {
namespace {

constexpr double kMakersShare = 0.8;
constexpr double kSlowness = 0.05;

// Solves the symmetric, positive system by the adjugate; its condition is that of a few springs beside each other.
Vec3 solve(const Mat3& a, const Vec3& b) noexcept {
  const Vec3 c0 = a.col(0), c1 = a.col(1), c2 = a.col(2);
  const Vec3 r0 = cross(c1, c2), r1 = cross(c2, c0), r2 = cross(c0, c1);
  return Vec3(dot(r0, b), dot(r1, b), dot(r2, b)) / dot(c0, r0);
}

}  // namespace

void check(const CouplingOptions& options) {
  require_finite("coupling.stiffness", options.stiffness);
  require_in_range("coupling.stiffness", options.stiffness, 0, 1e6);
}

double safe_stiffness(const DeviceInfo& info, const PassivityOptions& passivity, double tick) noexcept {
  const double lag = tick * (0.5 + passivity.delay);
  const double mass = info.mass > 0 ? info.mass : kUnknownMass;
  const double damped = (damping_limit(passivity, info, tick) + info.friction_damping) / lag;
  const double told = info.max_stiffness > 0 ? kMakersShare * info.max_stiffness : kMostStiffness;
  return std::min({kMostStiffness, told, damped, kSlowness * mass / (lag * lag)});
}

const Vec3& VirtualCoupling::move(const Vec3& device, const Vec3& force, const Mat3& stiffness, double mean) noexcept {
  Mat3 all = mean * stiffness;
  for (int axis = 0; axis < 3; ++axis) all(axis, axis) += stiffness_;
  position_ += solve(all, stiffness_ * (device - position_) + force);
  return position_;
}

}  // namespace crumble
