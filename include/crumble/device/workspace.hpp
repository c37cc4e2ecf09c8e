// Between a device's frame and the scene's.
#pragma once

#include "crumble/device/device.hpp"

namespace crumble {

/// scene position = pose (scale * device position); scene orientation = pose * device * mount.
struct WorkspaceOptions {
  Pose pose = {};                 // T: where the device's origin lies in the scene and how its axes are turned
  double scale = 1;               // s, > 0: scene metres per device metre
  double force_gain = 1;          // g, >= 0: 1 gives the hand the power that the scene takes
  Quat mount = Quat::Identity();  // how the tool is turned against the stylus that holds it
};

/// Motion goes to the scene by T s, force comes back by g s T^T. With g = 1 power is conserved, F_device . v_device =
/// F_scene . v_scene; a stiffness K of the scene feels like g s^2 K.
class Workspace {
 public:
  /// Throws Error: bad_pose, invalid_value, out_of_range, naming workspace.pose, .scale, .force_gain or .mount.
  explicit Workspace(const WorkspaceOptions& options = {});

  Pose to_scene(const Pose& device) const noexcept;
  /// Pose and velocities mapped, the rest as it is.
  DeviceSample to_scene(const DeviceSample& device) const noexcept;
  /// N in the scene to N at the device.
  Vec3 force_to_device(const Vec3& force) const noexcept;
  /// N m to N m; angles do not scale, so neither does a torque: g R^T torque.
  Vec3 torque_to_device(const Vec3& torque) const noexcept;
  /// N/m to N/m: g s^2 R^T K R.
  Mat3 stiffness_to_device(const Mat3& stiffness) const noexcept;

 private:
  Pose pose_;
  Mat3 rotation_;
  double scale_;
  double force_gain_;
  Quat mount_;
};

}  // namespace crumble
