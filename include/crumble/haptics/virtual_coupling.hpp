// A spring between the device and the tool.
//
// The device does not carry the tool rigidly but pulls it by a spring of stiffness Kc. Whatever the body does to the
// tool, the hand feels at most that spring, whose stiffness is known beforehand, not the sum of all contacts, which
// grows as the tool sinks in: a few hundred N/m instead of some thousand. The body under the tool is soft, so the feel
// loses little (docs/haptics.md). The tool has no mass: it goes where spring and body balance, by one step of
// Newton's method a tick,
//     (Kc + n K) dx = Kc (x_device - x) + F_body(x),    K = - dF_body/dx with neighbours held,
// damped by n, the ticks over which F_body is a mean: K answers at once, a mean n times later. Contacts that slide
// count in K as if they stuck: a sliding one has no stiffness along the surface, so that the tool would run away from
// its friction by all of friction / Kc in one tick, the friction turn round, and the tool come back in the next.
// Translations only; the tool turns with the device.
//
// After Colgate, Stanley and Brown (IROS 1995). Their coupling has a damper beside the spring; here it would work
// against the same velocity as the injected damping (haptics/passivity.hpp), which does its work.
#pragma once

#include "crumble/device/device.hpp"
#include "crumble/haptics/passivity.hpp"

namespace crumble {

struct CouplingOptions {
  bool enabled = true;
  double stiffness = 0;  // Kc as the hand feels it, N/m; 0: safe_stiffness()
};

/// Throws Error naming coupling.FIELD: invalid_value, out_of_range.
void check(const CouplingOptions& options);

/// The greatest Kc (N/m, as the hand feels it) for which a loop around a device like this is known to be quiet: at most
/// kMostStiffness, 0.8 of what its maker allows, what damping_limit() can make up for, and so slow against the delay
/// that a light hand does not ring: 5 % of mass / (time from sample to force)^2, chosen from the maps of
/// docs/haptics.md.
double safe_stiffness(const DeviceInfo& info, const PassivityOptions& passivity, double tick) noexcept;
inline constexpr double kMostStiffness = 1000;

/// Where the tool of one hand is.
class VirtualCoupling {
 public:
  /// `stiffness`: Kc in the scene, N/m, > 0.
  explicit VirtualCoupling(double stiffness) : stiffness_(stiffness) {}

  /// The device is at `device` (m), the body answers with `force` (N) and `stiffness` (N/m) to the tool where it is
  /// now. Returns where it goes.
  const Vec3& move(const Vec3& device, const Vec3& force, const Mat3& stiffness, double mean) noexcept;
  /// It is where the device is.
  void place(const Vec3& device) noexcept { position_ = device; }
  /// What the spring does to the device there, N.
  Vec3 force_at(const Vec3& device) const noexcept { return stiffness_ * (position_ - device); }

  double stiffness() const noexcept { return stiffness_; }

 private:
  double stiffness_;
  Vec3 position_ = Vec3::Zero();
};

}  // namespace crumble
