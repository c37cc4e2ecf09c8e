// hdGet: of the frame that is open, or of the last one.
#include <algorithm>
#include <cmath>

#include "parameters.hpp"

namespace fakehd {
namespace {

constexpr double kRoom = 1.5;  // the whole workspace, of the usable one

template <class Range>
void put(Values& out, const Range& values) {
  std::copy(values.begin(), values.end(), out.begin());
}

/// What a frame tells; false when `name` is none of it.
bool read_report(const Session& d, unsigned name, Values& out) {
  const Report& r = (name & 0xF00) >= 0x200 ? d.last : d.frame;  // all names of the last frame lie 0x200 higher
  switch (name) {
    case hd::kCurrentButtons:
    case hd::kLastButtons:
      return out[0] = r.buttons, true;
    case hd::kCurrentSafetySwitch:
    case hd::kLastSafetySwitch:
      return out[0] = 1, true;
    case hd::kCurrentInkwellSwitch:
    case hd::kLastInkwellSwitch:
      return out[0] = r.in_inkwell ? 0 : 1, true;
    case hd::kCurrentEncoderValues:
    case hd::kLastEncoderValues:
      for (std::size_t i = 0; i < 3; ++i) out[i] = std::round(r.joints[i] * 1000);
      return true;
    case hd::kCurrentPosition:
    case hd::kLastPosition:
      return put(out, r.position), true;
    case hd::kCurrentVelocity:
    case hd::kLastVelocity:
      return put(out, r.velocity), true;
    case hd::kCurrentTransform:
    case hd::kLastTransform:
      return put(out, r.transform), true;
    case hd::kCurrentJointAngles:
    case hd::kLastJointAngles:
      return put(out, r.joints), true;
    case hd::kCurrentGimbalAngles:
    case hd::kLastGimbalAngles:
      return put(out, r.gimbal), true;
    default:
      return false;
  }
}

bool read_force(const Session& d, unsigned name, Values& out) {
  switch (name) {
    case hd::kCurrentForce:
      return put(out, d.force), true;
    case hd::kCurrentTorque:
    case hd::kCurrentGimbalTorque:
      return put(out, d.torque), true;
    case hd::kCurrentJointTorque:
      return put(out, d.joint_torque), true;
    case hd::kLastForce:
      return put(out, d.last_force), true;
    case hd::kLastTorque:
    case hd::kLastGimbalTorque:
      return put(out, d.last_torque), true;
    case hd::kLastJointTorque:
      return put(out, d.last_joint_torque), true;
    default:
      return false;
  }
}

bool read_limit(const State& s, const Session& d, unsigned name, double& out) {
  const DeviceScript& script = script_of(s, d);
  switch (name) {
    case hd::kUpdateRate:
      return out = static_cast<double>(s.rate), true;
    case hd::kInstantaneousUpdateRate:
      return out = std::min(s.measured_rate, 1e6), true;
    case hd::kNominalMaxStiffness:
      return out = script.max_stiffness, true;
    case hd::kNominalMaxForce:
      return out = script.max_force, true;
    case hd::kNominalMaxContinuousForce:
      return out = script.continuous_force, true;
    case hd::kNominalMaxDamping:
      return out = script.max_damping, true;
    case hd::kSoftwareVelocityLimit:
      return out = d.velocity_limit, true;
    case hd::kSoftwareForceImpulseLimit:
      return out = d.impulse_limit, true;
    case hd::kForceRampingRate:
      return out = d.ramp_time, true;
    default:
      return false;
  }
}

/// What stays as long as the device is open. The angular velocity, which is not modelled, stays zero.
void read_constant(const State& s, const Session& d, unsigned name, Values& out) {
  const DeviceScript& script = script_of(s, d);
  if (name == hd::kFirmwareVersion) out[0] = 1;
  if (name == hd::kUsableWorkspace || name == hd::kMaxWorkspace) put(out, script.workspace);
  if (name == hd::kMaxWorkspace) {
    for (std::size_t i = 0; i < 6; ++i) out[i] *= kRoom;
  }
  if (name == hd::kTabletopOffset) out[0] = script.workspace[1] - 40;
  if (name == hd::kInputDof) out[0] = script.input_dof;
  if (name == hd::kOutputDof) out[0] = script.output_dof;
  if (name == hd::kCalibrationStyle) out[0] = calibration_style(script.calibration);
  if (name == hd::kMotorTemperature) put(out, d.temperature);
  if (name == hd::kUserStatusLight) out[0] = d.status_light;
}

bool fits(Type has, Type asked) {
  return has == asked || (has == Type::boolean && asked == Type::integer);
}

template <class T>
void get(unsigned name, T* values, Type asked) {
  Guard s;
  const Session* d = current_session(*s);
  if (!d) return;
  const Parameter* parameter = find_parameter(name);
  if (!parameter) return refuse(*s, hd::kInvalidEnum, "a name that does not exist", d->handle);
  if (!fits(parameter->type, asked)) return refuse(*s, hd::kInvalidInputType, "got as another type", d->handle);
  if (!values) return refuse(*s, hd::kInvalidValue, "hdGet into a null pointer", d->handle);
  if (!parameter->modelled) return push_error(*s, hd::kInvalidOperation, d->handle);
  if (name == hd::kLastTransform) misuse(*s, "the documents contradict each other on the layout of LAST_TRANSFORM");
  Values out{};
  if (!read_report(*d, name, out) && !read_force(*d, name, out) && !read_limit(*s, *d, name, out[0])) {
    read_constant(*s, *d, name, out);
  }
  const auto count = static_cast<std::size_t>(count_of(*parameter, script_of(*s, *d)));
  for (std::size_t i = 0; i < count; ++i) values[i] = static_cast<T>(out[i]);
}

}  // namespace
}  // namespace fakehd

using namespace fakehd;

void hdGetBooleanv(unsigned name, unsigned char* values) {
  get(name, values, Type::boolean);
}

void hdGetIntegerv(unsigned name, int* values) {
  get(name, values, Type::integer);
}

void hdGetLongv(unsigned name, long* values) {
  get(name, values, Type::integer);
}

void hdGetFloatv(unsigned name, float* values) {
  get(name, values, Type::real);
}

void hdGetDoublev(unsigned name, double* values) {
  get(name, values, Type::real);
}

const char* hdGetString(unsigned name) {
  Guard s;
  if (name == hd::kVersion) return "3.4.0 FAKE";
  const Session* d = current_session(*s);
  if (!d) return nullptr;
  switch (name) {
    case hd::kModelType:
      return script_of(*s, *d).model.c_str();
    case hd::kSerialNumber:
      return script_of(*s, *d).serial.c_str();
    case hd::kDriverVersion:
      return "0.0.1 FAKE";
    case hd::kVendor:
      return "FAKE, crumble's tests";
    default:
      const bool known = find_parameter(name) != nullptr;
      refuse(*s, known ? hd::kInvalidInputType : hd::kInvalidEnum, "a string that does not exist", d->handle);
      return nullptr;
  }
}
