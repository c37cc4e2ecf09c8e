#include "crumble/device/workspace.hpp"

#include "device/check.hpp"

namespace crumble {

Workspace::Workspace(const WorkspaceOptions& options)
    : pose_(options.pose), scale_(options.scale), force_gain_(options.force_gain), mount_(options.mount) {
  device::require_pose("workspace.pose", options.pose);
  require_positive("workspace.scale", options.scale);
  device::require_not_negative("workspace.force_gain", options.force_gain);
  device::require_pose("workspace.mount", {Vec3::Zero(), options.mount});
  mount_ = renormalized({Vec3::Zero(), options.mount}).orientation;
  pose_ = renormalized(options.pose);
  rotation_ = rotation_matrix(pose_.orientation);
}

Pose Workspace::to_scene(const Pose& device) const noexcept {
  return {pose_.position + rotate(rotation_, scale_ * device.position),
          multiply(multiply(pose_.orientation, device.orientation), mount_)};
}

DeviceSample Workspace::to_scene(const DeviceSample& device) const noexcept {
  DeviceSample scene = device;
  scene.pose = to_scene(device.pose);
  scene.linear_velocity = rotate(rotation_, scale_ * device.linear_velocity);
  scene.angular_velocity = rotate(rotation_, device.angular_velocity);
  return scene;
}

Vec3 Workspace::force_to_device(const Vec3& force) const noexcept {
  return (force_gain_ * scale_) * rotate_back(rotation_, force);
}

Vec3 Workspace::torque_to_device(const Vec3& torque) const noexcept {
  return force_gain_ * rotate_back(rotation_, torque);
}

Mat3 Workspace::stiffness_to_device(const Mat3& stiffness) const noexcept {
  Mat3 out;
  for (int axis = 0; axis < 3; ++axis) {
    out.col(axis) = (force_gain_ * scale_ * scale_) * rotate_back(rotation_, rotate(stiffness, rotation_.col(axis)));
  }
  return out;
}

}  // namespace crumble
