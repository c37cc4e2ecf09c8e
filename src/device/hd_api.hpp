// What of HDAPI 3.x the PHANToM adapter uses: types, numbers and prototypes, declared by ourselves so that nothing of
// the maker's is needed to build. The same in 3.0, 3.4 and 3.30. Where a real HD/hd.h is installed,
// tests/fakehd/conformance.cpp compares each line with it.
#pragma once

namespace crumble::device::hd {

static_assert(sizeof(void*) == 8, "HDAPI's calling convention differs between versions on 32-bit systems");

#ifdef _WIN32
#define CRUMBLE_HD_CALL __stdcall
#else
#define CRUMBLE_HD_CALL
#endif

using Handle = unsigned int;
using SchedulerHandle = unsigned long;  // 8 bytes on Linux, 4 on Windows
using Callback = unsigned int(CRUMBLE_HD_CALL*)(void*);
using Boolean = unsigned char;

struct ErrorInfo {
  unsigned int code;
  int internal_code;  // of the maker's own
  Handle device;
};
static_assert(sizeof(ErrorInfo) == 12);  // returned by value

inline constexpr Handle kInvalidHandle = 0xFFFFFFFF;

// Read in a frame
inline constexpr unsigned kCurrentButtons = 0x2000, kCurrentVelocity = 0x2051, kCurrentTransform = 0x2052,
                          kCurrentAngularVelocity = 0x2053;
// Identity and limits
inline constexpr unsigned kVersion = 0x2500, kModel = 0x2501, kDriverVersion = 0x2502, kVendor = 0x2503,
                          kSerial = 0x2504;
inline constexpr unsigned kUsableWorkspace = 0x2551, kOutputDof = 0x2554, kCalibrationStyle = 0x2555;
inline constexpr unsigned kUpdateRate = 0x2600, kMaxStiffness = 0x2602, kMaxForce = 0x2603, kContinuousForce = 0x2604,
                          kMotorTemperature = 0x2605, kVelocityLimit = 0x2606, kMaxDamping = 0x2609,
                          kMaxTorque = 0x2622;
// Written in a frame
inline constexpr unsigned kCurrentForce = 0x2700, kCurrentGimbalTorque = 0x2704;
// To enable
inline constexpr unsigned kForceOutput = 0x4000;
// Calibration
inline constexpr unsigned kCalibrationOk = 0x5000, kCalibrationNeedsUpdate = 0x5001, kCalibrationNeedsInput = 0x5002;
inline constexpr unsigned kEncoderReset = 1, kAutoCalibration = 2, kInkwell = 4;
// Scheduler
inline constexpr unsigned kCallbackDone = 0, kCallbackContinue = 1;
inline constexpr unsigned short kDefaultPriority = 32767;
// Errors
inline constexpr unsigned kSuccess = 0, kInvalidEnum = 0x100, kInvalidValue = 0x101, kInvalidOperation = 0x102,
                          kInvalidInputType = 0x103, kBadHandle = 0x104;
inline constexpr unsigned kWarmMotors = 0x200, kExceededForce = 0x201, kExceededImpulse = 0x202,
                          kExceededVelocity = 0x203, kForceError = 0x204;
inline constexpr unsigned kDeviceFault = 0x300, kAlreadyInitiated = 0x301, kCommError = 0x302, kCommConfigError = 0x303,
                          kTimerError = 0x304;
inline constexpr unsigned kIllegalBegin = 0x400, kIllegalEnd = 0x401, kFrameError = 0x402;
inline constexpr unsigned kInvalidPriority = 0x500, kSchedulerFull = 0x501, kInvalidLicense = 0x600;

/// The functions, by the names that they have without "hd".
struct Api {
  Handle(CRUMBLE_HD_CALL* InitDevice)(const char* name);
  void(CRUMBLE_HD_CALL* DisableDevice)(Handle);
  void(CRUMBLE_HD_CALL* MakeCurrentDevice)(Handle);
  void(CRUMBLE_HD_CALL* BeginFrame)(Handle);
  void(CRUMBLE_HD_CALL* EndFrame)(Handle);
  ErrorInfo(CRUMBLE_HD_CALL* GetError)();
  const char*(CRUMBLE_HD_CALL* GetErrorString)(unsigned code);
  void(CRUMBLE_HD_CALL* Enable)(unsigned capability);
  void(CRUMBLE_HD_CALL* GetIntegerv)(unsigned, int*);
  void(CRUMBLE_HD_CALL* GetDoublev)(unsigned, double*);
  const char*(CRUMBLE_HD_CALL* GetString)(unsigned);
  void(CRUMBLE_HD_CALL* SetDoublev)(unsigned, const double*);
  unsigned(CRUMBLE_HD_CALL* CheckCalibration)();
  void(CRUMBLE_HD_CALL* UpdateCalibration)(unsigned style);
  void(CRUMBLE_HD_CALL* StartScheduler)();
  void(CRUMBLE_HD_CALL* StopScheduler)();
  void(CRUMBLE_HD_CALL* SetSchedulerRate)(unsigned long hertz);
  SchedulerHandle(CRUMBLE_HD_CALL* ScheduleAsynchronous)(Callback, void* context, unsigned short priority);
  void(CRUMBLE_HD_CALL* Unschedule)(SchedulerHandle);
  Boolean(CRUMBLE_HD_CALL* DeploymentLicense)(const char* vendor, const char* application,
                                              const char* password);  // null: this library has none
};

}  // namespace crumble::device::hd
