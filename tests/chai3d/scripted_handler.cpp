#include "scripted_device.hpp"

bool chai3d::cHapticDeviceHandler::getDevice(cGenericHapticDevicePtr& device, unsigned int) {
  device = std::make_shared<ScriptedDevice>();
  return true;
}
