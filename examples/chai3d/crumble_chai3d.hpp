// A CHAI3D device as a crumble device: whatever CHAI3D opens, crumble_loop can drive, behind its safety stages. To be
// copied into a program that uses both; docs/guides/chai3d.md says how. Written from CHAI3D 3.2's public documentation
// and sources, compiled against a double of the classes that it uses, and not tested with CHAI3D.
#pragma once
#include <crumble/crumble.h>

#include <memory>
#include <string>
#include <utility>

#include "chai3d.h"

namespace crumble_chai3d {

// CHAI3D has x towards the user, y to the right and z up, crumble x to the right, y up and z towards the user: the same
// three axes, in another order. Both have metres, newtons and right-handed axes, so no more is to be done.
inline void to_crumble(const chai3d::cVector3d& from, double to[3]) {
  to[0] = from(1), to[1] = from(2), to[2] = from(0);
}
inline chai3d::cVector3d to_chai3d(const double from[3]) {
  return chai3d::cVector3d(from[2], from[0], from[1]);
}
// The axes of the handle are renamed like those of the room. CHAI3D's stylus lies along its x, which becomes our z: the
// axis of crumble's default stick.
inline void to_crumble(const chai3d::cMatrix3d& from, double to[4]) {
  chai3d::cQuaternion q;
  q.fromRotMat(from);
  q.normalize();
  to[0] = q.w, to[1] = q.y, to[2] = q.z, to[3] = q.x;
}

// Open and calibrate the CHAI3D device first, and leave it to the bridge as long as crumble has it: its functions are
// called from the thread that ticks the loop, and from no other but the loop's watchdog while no tick is on.
class Bridge {
 public:
  // `senses_velocity`: the device measures its velocity. Most do not, and CHAI3D derives it over 15 ms; without that
  // crumble derives it over 5 ms at most, which is what damping wants.
  explicit Bridge(chai3d::cGenericHapticDevicePtr device, bool senses_velocity = false)
      : device_(std::move(device)), senses_velocity_(senses_velocity) {}
  Bridge(const Bridge&) = delete;  // crumble has its address
  Bridge& operator=(const Bridge&) = delete;

  // Destroy `out` before the bridge.
  crumble_result open(crumble_device* out) {
    crumble_device_callbacks callbacks;
    crumble_result result = crumble_device_callbacks_init(&callbacks, sizeof callbacks);
    if (result != CRUMBLE_OK) return result;
    describe(callbacks);
    crumble_device_def def;
    result = crumble_device_def_init(&def, sizeof def);
    def.kind = CRUMBLE_DEVICE_CUSTOM;
    def.callbacks = &callbacks;
    return result == CRUMBLE_OK ? crumble_device_open(&def, out) : result;
  }

 private:
  void describe(crumble_device_callbacks& to) {
    const chai3d::cHapticDeviceInfo told = device_->getSpecifications();
    name_ = told.m_manufacturerName + " " + told.m_modelName + " through CHAI3D";
    senses_rotation_ = told.m_sensedRotation;
    turns_ = told.m_actuatedRotation;
    to.name = name_.c_str();
    to.user = this;
    to.read = read;
    to.write = write;
    to.measured = CRUMBLE_SENSES_POSITION | CRUMBLE_SENSES_BUTTONS;
    if (senses_rotation_) to.measured |= CRUMBLE_SENSES_ORIENTATION;
    if (senses_velocity_) to.measured |= CRUMBLE_SENSES_LINEAR_VELOCITY;
    to.max_force = told.m_actuatedPosition ? told.m_maxLinearForce : 0;
    to.max_torque = turns_ ? told.m_maxAngularTorque : 0;
    to.max_stiffness = told.m_maxLinearStiffness;
    to.max_damping = told.m_maxLinearDamping;
    for (int axis = 0; axis < 3; ++axis) {  // CHAI3D has the origin in the middle of the workspace
      to.workspace_low[axis] = -told.m_workspaceRadius;
      to.workspace_high[axis] = told.m_workspaceRadius;
    }
  }

  // A call that CHAI3D answers with false loses the device: the hand gets no force and the loop says why.
  static crumble_result read(crumble_device_sample* sample, void* user) {
    const Bridge& self = *static_cast<Bridge*>(user);
    chai3d::cVector3d position, velocity;
    unsigned int buttons = 0;
    if (!self.device_->getPosition(position)) return CRUMBLE_E_IO;
    to_crumble(position, sample->pose.position);
    if (self.senses_rotation_) {
      chai3d::cMatrix3d rotation;
      if (!self.device_->getRotation(rotation)) return CRUMBLE_E_IO;
      to_crumble(rotation, sample->pose.orientation);
    }
    if (self.senses_velocity_) {
      if (!self.device_->getLinearVelocity(velocity)) return CRUMBLE_E_IO;
      to_crumble(velocity, sample->linear_velocity);
    }
    if (!self.device_->getUserSwitches(buttons)) return CRUMBLE_E_IO;
    sample->buttons = buttons;
    return CRUMBLE_OK;
  }

  static crumble_result write(const double* force, const double* torque, void* user) {
    const Bridge& self = *static_cast<Bridge*>(user);
    const double none[3] = {0, 0, 0};
    const bool sent =
        self.device_->setForceAndTorqueAndGripperForce(to_chai3d(force), to_chai3d(self.turns_ ? torque : none), 0.0);
    return sent ? CRUMBLE_OK : CRUMBLE_E_IO;
  }

  chai3d::cGenericHapticDevicePtr device_;
  bool senses_velocity_;
  bool senses_rotation_ = false;
  bool turns_ = false;
  std::string name_;
};

}  // namespace crumble_chai3d
