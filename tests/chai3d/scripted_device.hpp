// A device as CHAI3D would open it: it goes where a script says and keeps what it was sent.
#pragma once
#include <functional>
#include <vector>

#include "chai3d.h"

struct ScriptedDevice : chai3d::cGenericHapticDevice {
  struct Sent {
    double force[3], torque[3];
  };

  ScriptedDevice() {
    m_specifications.m_modelName = "script";
    m_specifications.m_manufacturerName = "double";
    m_specifications.m_maxLinearForce = 2;
    m_specifications.m_maxAngularTorque = 0.05;
    m_specifications.m_maxLinearStiffness = 400;
    m_specifications.m_maxLinearDamping = 4;
    m_specifications.m_workspaceRadius = 0.075;
    m_specifications.m_sensedPosition = m_specifications.m_actuatedPosition = true;
    for (int row = 0; row < 3; ++row) {
      for (int column = 0; column < 3; ++column) rotation(row, column) = row == column;
    }
  }

  bool open() override { return true; }
  bool close() override { return true; }
  bool calibrate(bool) override { return true; }
  bool getPosition(chai3d::cVector3d& to) override {
    to = script(reads++);
    return works;
  }
  bool getLinearVelocity(chai3d::cVector3d& to) override {
    to = velocity;
    return works;
  }
  bool getRotation(chai3d::cMatrix3d& to) override {
    to = rotation;
    return works;
  }
  bool getUserSwitches(unsigned int& to) override {
    to = buttons;
    return works;
  }
  bool setForceAndTorqueAndGripperForce(const chai3d::cVector3d& f, const chai3d::cVector3d& t, double) override {
    sent.push_back({{f(0), f(1), f(2)}, {t(0), t(1), t(2)}});
    return works;
  }

  // Down by 14 mm, at 10 mm/s, after half a second; CHAI3D's axes.
  static chai3d::cVector3d press(int read) {
    const double time = 1e-3 * read - 0.5;
    return chai3d::cVector3d(0, 0, time < 0 ? 0 : time > 1.4 ? -0.014 : -0.01 * time);
  }

  std::function<chai3d::cVector3d(int)> script = press;
  chai3d::cVector3d velocity{0, 0, 0};
  chai3d::cMatrix3d rotation;
  unsigned int buttons = 0;
  bool works = true;
  int reads = 0;
  std::vector<Sent> sent;
};
