#include "parameters.hpp"

namespace fakehd {
namespace {

constexpr Parameter kParameters[] = {
    {hd::kCurrentButtons, Type::integer, 1},
    {hd::kCurrentSafetySwitch, Type::boolean, 1},
    {hd::kCurrentInkwellSwitch, Type::boolean, 1},
    {hd::kCurrentEncoderValues, Type::integer, 6},
    {hd::kCurrentPosition, Type::real, 3},
    {hd::kCurrentVelocity, Type::real, 3},
    {hd::kCurrentTransform, Type::real, 16},
    {hd::kCurrentAngularVelocity, Type::real, 3},
    {hd::kCurrentJacobian, Type::real, 16, false, false, false},
    {hd::kCurrentJointAngles, Type::real, 3},
    {hd::kCurrentGimbalAngles, Type::real, 3},
    {hd::kLastButtons, Type::integer, 1},
    {hd::kLastSafetySwitch, Type::boolean, 1},
    {hd::kLastInkwellSwitch, Type::boolean, 1},
    {hd::kLastEncoderValues, Type::integer, 6},
    {hd::kLastPosition, Type::real, 3},
    {hd::kLastVelocity, Type::real, 3},
    {hd::kLastTransform, Type::real, 16},
    {hd::kLastAngularVelocity, Type::real, 3},
    {hd::kLastJointAngles, Type::real, 3},
    {hd::kLastGimbalAngles, Type::real, 3},
    {hd::kLastForce, Type::real, 3},
    {hd::kLastTorque, Type::real, 3},
    {hd::kLastJointTorque, Type::real, 3},
    {hd::kLastGimbalTorque, Type::real, 3},
    {hd::kVersion, Type::text, 1},
    {hd::kModelType, Type::text, 1},
    {hd::kDriverVersion, Type::text, 1},
    {hd::kVendor, Type::text, 1},
    {hd::kSerialNumber, Type::text, 1},
    {hd::kFirmwareVersion, Type::real, 1},
    {hd::kMaxWorkspace, Type::real, 6},
    {hd::kUsableWorkspace, Type::real, 6},
    {hd::kTabletopOffset, Type::real, 1},
    {hd::kInputDof, Type::integer, 1},
    {hd::kOutputDof, Type::integer, 1},
    {hd::kCalibrationStyle, Type::integer, 1},
    {hd::kUpdateRate, Type::integer, 1},
    {hd::kInstantaneousUpdateRate, Type::integer, 1},
    {hd::kNominalMaxStiffness, Type::real, 1},
    {hd::kNominalMaxForce, Type::real, 1},
    {hd::kNominalMaxContinuousForce, Type::real, 1},
    {hd::kMotorTemperature, Type::real, 0},
    {hd::kSoftwareVelocityLimit, Type::real, 1, true},
    {hd::kSoftwareForceImpulseLimit, Type::real, 1, true},
    {hd::kForceRampingRate, Type::real, 1, true},
    {hd::kNominalMaxDamping, Type::real, 1},
    {hd::kTorqueLimitFirst, Type::real, 1, false, false, false},
    {hd::kTorqueLimitFirst + 1, Type::real, 1, false, false, false},
    {hd::kTorqueLimitLast - 1, Type::real, 1, false, false, false},
    {hd::kTorqueLimitLast, Type::real, 1, false, false, false},
    {hd::kCurrentForce, Type::real, 3, true, true},
    {hd::kCurrentTorque, Type::real, 3, true, true},
    {hd::kCurrentJointTorque, Type::real, 3, true, true},
    {hd::kCurrentGimbalTorque, Type::real, 3, true, true},
    {hd::kCurrentMotorDac, Type::integer, 6, true, true, false},
    {hd::kUserStatusLight, Type::integer, 1, true},
};

}  // namespace

const Parameter* find_parameter(unsigned name) {
  for (const Parameter& parameter : kParameters) {
    if (parameter.name == name) return &parameter;
  }
  return nullptr;
}

int count_of(const Parameter& parameter, const DeviceScript& script) {
  return parameter.count > 0 ? parameter.count : script.output_dof;
}

}  // namespace fakehd
