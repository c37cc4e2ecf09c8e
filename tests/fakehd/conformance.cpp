// Our declarations of HDAPI against the maker's, where those are installed. Compiled and never run.
#include <HD/hd.h>

#include <type_traits>

#include "device/hd_api.hpp"

namespace crumble::device::hd {
namespace {

static_assert(sizeof(::HHD) == sizeof(Handle) && sizeof(::HDSchedulerHandle) == sizeof(SchedulerHandle));
static_assert(sizeof(::HDErrorInfo) == sizeof(ErrorInfo) && sizeof(::HDboolean) == sizeof(Boolean));
static_assert(HD_INVALID_HANDLE == kInvalidHandle);

static_assert(HD_CURRENT_BUTTONS == kCurrentButtons && HD_CURRENT_VELOCITY == kCurrentVelocity);
static_assert(HD_CURRENT_TRANSFORM == kCurrentTransform && HD_CURRENT_ANGULAR_VELOCITY == kCurrentAngularVelocity);
static_assert(HD_VERSION == kVersion && HD_DEVICE_MODEL_TYPE == kModel && HD_DEVICE_DRIVER_VERSION == kDriverVersion);
static_assert(HD_DEVICE_VENDOR == kVendor && HD_DEVICE_SERIAL_NUMBER == kSerial);
static_assert(HD_USABLE_WORKSPACE_DIMENSIONS == kUsableWorkspace && HD_OUTPUT_DOF == kOutputDof);
static_assert(HD_CALIBRATION_STYLE == kCalibrationStyle && HD_UPDATE_RATE == kUpdateRate);
static_assert(HD_NOMINAL_MAX_STIFFNESS == kMaxStiffness && HD_NOMINAL_MAX_FORCE == kMaxForce);
static_assert(HD_NOMINAL_MAX_CONTINUOUS_FORCE == kContinuousForce && HD_MOTOR_TEMPERATURE == kMotorTemperature);
static_assert(HD_SOFTWARE_VELOCITY_LIMIT == kVelocityLimit && HD_NOMINAL_MAX_DAMPING == kMaxDamping);
static_assert(HD_NOMINAL_MAX_TORQUE_FORCE == kMaxTorque);
static_assert(HD_CURRENT_FORCE == kCurrentForce && HD_CURRENT_GIMBAL_TORQUE == kCurrentGimbalTorque);
static_assert(HD_FORCE_OUTPUT == kForceOutput);
static_assert(HD_CALIBRATION_OK == kCalibrationOk && HD_CALIBRATION_NEEDS_UPDATE == kCalibrationNeedsUpdate);
static_assert(HD_CALIBRATION_NEEDS_MANUAL_INPUT == kCalibrationNeedsInput);
static_assert(HD_CALIBRATION_ENCODER_RESET == kEncoderReset && HD_CALIBRATION_AUTO == kAutoCalibration);
static_assert(HD_CALIBRATION_INKWELL == kInkwell);
static_assert(HD_CALLBACK_DONE == kCallbackDone && HD_CALLBACK_CONTINUE == kCallbackContinue);
static_assert(HD_DEFAULT_SCHEDULER_PRIORITY == kDefaultPriority);

static_assert(HD_SUCCESS == kSuccess && HD_INVALID_ENUM == kInvalidEnum && HD_INVALID_VALUE == kInvalidValue);
static_assert(HD_INVALID_OPERATION == kInvalidOperation && HD_INVALID_INPUT_TYPE == kInvalidInputType);
static_assert(HD_BAD_HANDLE == kBadHandle && HD_WARM_MOTORS == kWarmMotors);
static_assert(HD_EXCEEDED_MAX_FORCE == kExceededForce && HD_EXCEEDED_MAX_FORCE_IMPULSE == kExceededImpulse);
static_assert(HD_EXCEEDED_MAX_VELOCITY == kExceededVelocity && HD_FORCE_ERROR == kForceError);
static_assert(HD_DEVICE_FAULT == kDeviceFault && HD_DEVICE_ALREADY_INITIATED == kAlreadyInitiated);
static_assert(HD_COMM_ERROR == kCommError && HD_COMM_CONFIG_ERROR == kCommConfigError);
static_assert(HD_TIMER_ERROR == kTimerError && HD_ILLEGAL_BEGIN == kIllegalBegin && HD_ILLEGAL_END == kIllegalEnd);
static_assert(HD_FRAME_ERROR == kFrameError && HD_INVALID_PRIORITY == kInvalidPriority);
static_assert(HD_SCHEDULER_FULL == kSchedulerFull && HD_INVALID_LICENSE == kInvalidLicense);

// The struct that hdGetError returns and the callback's type are ours, so these compare by what the call does.
template <class Theirs, class Ours>
constexpr bool kSame = std::is_same_v<Theirs, std::remove_pointer_t<Ours>>;
static_assert(kSame<decltype(::hdInitDevice), decltype(Api::InitDevice)>);
static_assert(kSame<decltype(::hdDisableDevice), decltype(Api::DisableDevice)>);
static_assert(kSame<decltype(::hdMakeCurrentDevice), decltype(Api::MakeCurrentDevice)>);
static_assert(kSame<decltype(::hdBeginFrame), decltype(Api::BeginFrame)>);
static_assert(kSame<decltype(::hdEndFrame), decltype(Api::EndFrame)>);
static_assert(std::is_same_v<decltype(::hdGetError()), ::HDErrorInfo>);
static_assert(kSame<decltype(::hdGetErrorString), decltype(Api::GetErrorString)>);
static_assert(kSame<decltype(::hdEnable), decltype(Api::Enable)>);
static_assert(kSame<decltype(::hdGetIntegerv), decltype(Api::GetIntegerv)>);
static_assert(kSame<decltype(::hdGetDoublev), decltype(Api::GetDoublev)>);
static_assert(kSame<decltype(::hdGetString), decltype(Api::GetString)>);
static_assert(kSame<decltype(::hdSetDoublev), decltype(Api::SetDoublev)>);
static_assert(kSame<decltype(::hdCheckCalibration), decltype(Api::CheckCalibration)>);
static_assert(kSame<decltype(::hdUpdateCalibration), decltype(Api::UpdateCalibration)>);
static_assert(kSame<decltype(::hdStartScheduler), decltype(Api::StartScheduler)>);
static_assert(kSame<decltype(::hdStopScheduler), decltype(Api::StopScheduler)>);
static_assert(kSame<decltype(::hdSetSchedulerRate), decltype(Api::SetSchedulerRate)>);
static_assert(kSame<decltype(::hdScheduleAsynchronous), decltype(Api::ScheduleAsynchronous)>);
static_assert(kSame<decltype(::hdUnschedule), decltype(Api::Unschedule)>);

}  // namespace
}  // namespace crumble::device::hd
