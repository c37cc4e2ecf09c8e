// A double of the few CHAI3D classes that examples/chai3d uses, so that these can be compiled and run where CHAI3D is
// not: names, signatures and axes are those of its public documentation and of its sources, version 3.2; the rest is
// ours. It shows that the bridge does what it says to such classes, and nothing about CHAI3D or a device.
#pragma once
#include <cmath>
#include <functional>
#include <memory>
#include <string>
#include <thread>

namespace chai3d {

struct cVector3d {
  cVector3d() {}
  cVector3d(double x, double y, double z) : m_{x, y, z} {}
  double& operator()(int i) { return m_[i]; }
  const double& operator()(int i) const { return m_[i]; }

 private:
  double m_[3];  // undefined until set, as CHAI3D's
};

struct cMatrix3d {
  double& operator()(int row, int column) { return m_[row][column]; }
  const double& operator()(int row, int column) const { return m_[row][column]; }

 private:
  double m_[3][3];
};

struct cQuaternion {
  double w, x, y, z;

  // Of the four components the largest is taken from the diagonal.
  void fromRotMat(cMatrix3d const& r) {
    double* const part[3] = {&x, &y, &z};
    int most = 0;
    for (int i = 1; i < 3; ++i) {
      if (r(i, i) > r(most, most)) most = i;
    }
    const int j = (most + 1) % 3, k = (most + 2) % 3;
    const double trace = r(0, 0) + r(1, 1) + r(2, 2);
    if (trace > r(most, most)) {
      w = 0.5 * std::sqrt(1 + trace);
      for (int i = 0; i < 3; ++i) *part[i] = (r((i + 2) % 3, (i + 1) % 3) - r((i + 1) % 3, (i + 2) % 3)) / (4 * w);
    } else {
      const double large = 0.5 * std::sqrt(1 + r(most, most) - r(j, j) - r(k, k));
      *part[most] = large;
      *part[j] = (r(most, j) + r(j, most)) / (4 * large);
      *part[k] = (r(most, k) + r(k, most)) / (4 * large);
      w = (r(k, j) - r(j, k)) / (4 * large);
    }
  }
  void normalize() {
    const double length = std::sqrt(w * w + x * x + y * y + z * z);
    w /= length, x /= length, y /= length, z /= length;
  }
};

struct cHapticDeviceInfo {
  std::string m_modelName, m_manufacturerName;
  double m_maxLinearForce = 0, m_maxAngularTorque = 0, m_maxLinearStiffness = 0, m_maxLinearDamping = 0;
  double m_workspaceRadius = 0;
  bool m_sensedPosition = false, m_sensedRotation = false, m_actuatedPosition = false, m_actuatedRotation = false;
};

class cGenericHapticDevice {
 public:
  virtual ~cGenericHapticDevice() {}
  virtual bool open() { return false; }
  virtual bool close() { return false; }
  virtual bool calibrate(bool = false) { return false; }
  virtual bool getPosition(cVector3d&) { return false; }
  virtual bool getLinearVelocity(cVector3d&) { return false; }
  virtual bool getRotation(cMatrix3d&) { return false; }
  virtual bool getUserSwitches(unsigned int&) { return false; }
  virtual bool setForceAndTorqueAndGripperForce(const cVector3d&, const cVector3d&, double) { return false; }
  cHapticDeviceInfo getSpecifications() { return m_specifications; }
  cHapticDeviceInfo m_specifications;
};
typedef std::shared_ptr<cGenericHapticDevice> cGenericHapticDevicePtr;

enum CThreadPriority { CTHREAD_PRIORITY_GRAPHICS, CTHREAD_PRIORITY_HAPTICS };

class cThread {
 public:
  void start(void (*function)(void), CThreadPriority) { std::thread(function).detach(); }
};

class cHapticDeviceHandler {
 public:
  bool getDevice(cGenericHapticDevicePtr& device, unsigned int = 0);
};

}  // namespace chai3d
