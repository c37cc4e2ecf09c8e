/* Types, values and prototypes of HDAPI as the double has them, for Linux on x86-64. Typed from the public facts, and
   on purpose a second time: the adapter has a table of its own; a common one would let a wrong number pass both. */
#ifndef CRUMBLE_TESTS_FAKEHD_HD_NAMES_H
#define CRUMBLE_TESTS_FAKEHD_HD_NAMES_H

#define FAKEHD_EXPORT __attribute__((visibility("default")))

extern "C" {
struct HdErrorInfo {
  unsigned code;
  int internal;
  unsigned device;
};
typedef unsigned (*HdCallback)(void* user);

FAKEHD_EXPORT unsigned hdInitDevice(const char* name);
FAKEHD_EXPORT void hdDisableDevice(unsigned device);
FAKEHD_EXPORT void hdMakeCurrentDevice(unsigned device);
FAKEHD_EXPORT unsigned hdGetCurrentDevice(void);
FAKEHD_EXPORT void hdBeginFrame(unsigned device);
FAKEHD_EXPORT void hdEndFrame(unsigned device);
FAKEHD_EXPORT HdErrorInfo hdGetError(void);
FAKEHD_EXPORT const char* hdGetErrorString(unsigned code);
FAKEHD_EXPORT void hdEnable(unsigned capability);
FAKEHD_EXPORT void hdDisable(unsigned capability);
FAKEHD_EXPORT unsigned char hdIsEnabled(unsigned capability);
FAKEHD_EXPORT void hdGetBooleanv(unsigned name, unsigned char* values);
FAKEHD_EXPORT void hdGetIntegerv(unsigned name, int* values);
FAKEHD_EXPORT void hdGetFloatv(unsigned name, float* values);
FAKEHD_EXPORT void hdGetDoublev(unsigned name, double* values);
FAKEHD_EXPORT void hdGetLongv(unsigned name, long* values);
FAKEHD_EXPORT const char* hdGetString(unsigned name);
FAKEHD_EXPORT void hdSetBooleanv(unsigned name, const unsigned char* values);
FAKEHD_EXPORT void hdSetIntegerv(unsigned name, const int* values);
FAKEHD_EXPORT void hdSetFloatv(unsigned name, const float* values);
FAKEHD_EXPORT void hdSetDoublev(unsigned name, const double* values);
FAKEHD_EXPORT void hdSetLongv(unsigned name, const long* values);
FAKEHD_EXPORT unsigned hdCheckCalibration(void);
FAKEHD_EXPORT unsigned hdCheckCalibrationStyle(void);
FAKEHD_EXPORT void hdUpdateCalibration(unsigned style);
FAKEHD_EXPORT void hdUpdateCalibrationMessage(unsigned style);
FAKEHD_EXPORT void hdStartScheduler(void);
FAKEHD_EXPORT void hdStopScheduler(void);
FAKEHD_EXPORT void hdSetSchedulerRate(unsigned long rate);
FAKEHD_EXPORT unsigned long hdScheduleAsynchronous(HdCallback callback, void* user, unsigned short priority);
FAKEHD_EXPORT void hdScheduleSynchronous(HdCallback callback, void* user, unsigned short priority);
FAKEHD_EXPORT void hdUnschedule(unsigned long handle);
FAKEHD_EXPORT unsigned char hdWaitForCompletion(unsigned long handle, unsigned code);
FAKEHD_EXPORT double hdGetSchedulerTimeStamp(void);
FAKEHD_EXPORT unsigned char hdDeploymentLicense(const char* vendor, const char* application, const char* password);
}

static_assert(sizeof(HdErrorInfo) == 12 && sizeof(long) == 8 && sizeof(void*) == 8);

namespace hd {

enum : unsigned {
  kInvalidHandle = 0xFFFFFFFF,

  kCurrentButtons = 0x2000,
  kCurrentSafetySwitch = 0x2001,
  kCurrentInkwellSwitch = 0x2002,
  kCurrentEncoderValues = 0x2010,
  kCurrentPosition = 0x2050,
  kCurrentVelocity = 0x2051,
  kCurrentTransform = 0x2052,
  kCurrentAngularVelocity = 0x2053,
  kCurrentJacobian = 0x2054,
  kCurrentJointAngles = 0x2100,
  kCurrentGimbalAngles = 0x2150,

  kLastButtons = 0x2200,
  kLastSafetySwitch = 0x2201,
  kLastInkwellSwitch = 0x2202,
  kLastEncoderValues = 0x2210,
  kLastPosition = 0x2250,
  kLastVelocity = 0x2251,
  kLastTransform = 0x2252,
  kLastAngularVelocity = 0x2253,
  kLastJointAngles = 0x2300,
  kLastGimbalAngles = 0x2350,
  kLastForce = 0x2800,
  kLastTorque = 0x2801,
  kLastJointTorque = 0x2802,
  kLastGimbalTorque = 0x2803,

  kVersion = 0x2500,
  kModelType = 0x2501,
  kDriverVersion = 0x2502,
  kVendor = 0x2503,
  kSerialNumber = 0x2504,
  kFirmwareVersion = 0x2505,

  kMaxWorkspace = 0x2550,
  kUsableWorkspace = 0x2551,
  kTabletopOffset = 0x2552,
  kInputDof = 0x2553,
  kOutputDof = 0x2554,
  kCalibrationStyle = 0x2555,

  kUpdateRate = 0x2600,
  kInstantaneousUpdateRate = 0x2601,
  kNominalMaxStiffness = 0x2602,
  kNominalMaxForce = 0x2603,
  kNominalMaxContinuousForce = 0x2604,
  kMotorTemperature = 0x2605,
  kSoftwareVelocityLimit = 0x2606,
  kSoftwareForceImpulseLimit = 0x2607,
  kForceRampingRate = 0x2608,
  kNominalMaxDamping = 0x2609,
  kTorqueLimitFirst = 0x2620,  // four, which is which is not in the facts
  kTorqueLimitLast = 0x2623,

  kCurrentForce = 0x2700,
  kCurrentTorque = 0x2701,
  kCurrentJointTorque = 0x2703,
  kCurrentGimbalTorque = 0x2704,
  kCurrentMotorDac = 0x2750,
  kUserStatusLight = 0x2900,

  kForceOutput = 0x4000,
  kMaxForceClamping = 0x4001,
  kForceRamping = 0x4002,
  kSoftwareForceLimit = 0x4003,
  kOneFrameLimit = 0x4004,

  kCalibrationOk = 0x5000,
  kCalibrationNeedsUpdate = 0x5001,
  kCalibrationNeedsManualInput = 0x5002,
  kStyleEncoderReset = 1,
  kStyleAuto = 2,
  kStyleInkwell = 4,

  kDone = 0,
  kContinue = 1,
  kWaitCheckStatus = 0,
  kWaitInfinite = 1,

  kSuccess = 0,
  kInvalidEnum = 0x100,
  kInvalidValue = 0x101,
  kInvalidOperation = 0x102,
  kInvalidInputType = 0x103,
  kBadHandle = 0x104,
  kWarmMotors = 0x200,
  kExceededMaxForce = 0x201,
  kExceededMaxForceImpulse = 0x202,
  kExceededMaxVelocity = 0x203,
  kForceError = 0x204,
  kDeviceFault = 0x300,
  kDeviceAlreadyInitiated = 0x301,
  kCommError = 0x302,
  kCommConfigError = 0x303,
  kTimerError = 0x304,
  kIllegalBegin = 0x400,
  kIllegalEnd = 0x401,
  kFrameError = 0x402,
  kInvalidPriority = 0x500,
  kSchedulerFull = 0x501,
  kInvalidLicense = 0x600,
};

}  // namespace hd

#endif
