#include "device/hd_errors.hpp"

#include "device/hd_api.hpp"

namespace crumble::device::hd {
namespace {

struct Entry {
  unsigned code;
  ErrorText error;
};

using enum ErrorClass;
constexpr Entry kErrors[] = {
    {kInvalidEnum, {force_off, "HD_INVALID_ENUM", "the driver does not know what was asked of it"}},
    {kInvalidValue, {force_off, "HD_INVALID_VALUE", "the driver refused a value"}},
    {kInvalidOperation, {force_off, "HD_INVALID_OPERATION", "the driver refused a call"}},
    {kInvalidInputType, {force_off, "HD_INVALID_INPUT_TYPE", "the driver wants another type of number"}},
    {kBadHandle, {lost, "HD_BAD_HANDLE", "the driver does not know the device any more"}},
    {kWarmMotors, {warm, "HD_WARM_MOTORS", "the motors are hot"}},
    {kExceededForce, {force_off, "HD_EXCEEDED_MAX_FORCE", "the driver stopped a force above its limit"}},
    {kExceededImpulse, {force_off, "HD_EXCEEDED_MAX_FORCE_IMPULSE", "the driver stopped a force that grew too fast"}},
    {kExceededVelocity, {force_off, "HD_EXCEEDED_MAX_VELOCITY", "the driver stopped a hand that moved too fast"}},
    {kForceError, {force_off, "HD_FORCE_ERROR", "the driver stopped the force"}},
    {kDeviceFault, {force_off, "HD_DEVICE_FAULT", "the device stopped its motors; a tick may have taken too long"}},
    {kAlreadyInitiated, {force_off, "HD_DEVICE_ALREADY_INITIATED", "the device is open already"}},
    {kCommError, {lost, "HD_COMM_ERROR", "the device does not answer: unplugged, or without power?"}},
    {kCommConfigError, {lost, "HD_COMM_CONFIG_ERROR", "the driver is not configured for this device"}},
    {kTimerError, {lost, "HD_TIMER_ERROR", "the driver's servo thread has no timer"}},
    {kIllegalBegin, {force_off, "HD_ILLEGAL_BEGIN", "a frame was begun twice in a tick"}},
    {kIllegalEnd, {force_off, "HD_ILLEGAL_END", "a frame was ended that was not begun"}},
    {kFrameError, {force_off, "HD_FRAME_ERROR", "a force was set outside a frame"}},
    {kInvalidPriority, {lost, "HD_INVALID_PRIORITY", "the scheduler does not take the priority"}},
    {kSchedulerFull, {lost, "HD_SCHEDULER_FULL", "the scheduler takes no more callbacks"}},
    {kInvalidLicense, {lost, "HD_INVALID_LICENSE", "the license was not accepted"}},
};
constexpr ErrorText kUnknown = {force_off, "an unknown error", "the driver told an error that has no name here"};

}  // namespace

const ErrorText& describe(unsigned code) noexcept {
  for (const Entry& entry : kErrors) {
    if (entry.code == code) return entry.error;
  }
  return kUnknown;
}

}  // namespace crumble::device::hd
