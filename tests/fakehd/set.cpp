// hdSet: forces within a frame, limits at any time.
#include <cmath>

#include "parameters.hpp"

namespace fakehd {
namespace {

/// What keeps `name` from being set now, 0 if nothing does.
unsigned set_problem(const Session& d, const DeviceScript& script, const Parameter* p, Type as) {
  if (!p || !p->settable) return hd::kInvalidEnum;
  if (p->type != as) return hd::kInvalidInputType;
  if (p->in_frame && !d.frame_open) return hd::kFrameError;
  const bool torque = p->name == hd::kCurrentTorque || p->name == hd::kCurrentGimbalTorque;
  if (!p->modelled || (torque && script.output_dof < 6)) return hd::kInvalidOperation;
  return 0;
}

bool set_vector(Session& d, unsigned name, const Vec& v) {
  switch (name) {
    case hd::kCurrentForce:
      return d.force = v, true;
    case hd::kCurrentTorque:
    case hd::kCurrentGimbalTorque:
      return d.torque = v, true;
    case hd::kCurrentJointTorque:
      d.joint_torque_set = true;  // takes the place of the force
      return d.joint_torque = v, true;
    default:
      return false;
  }
}

void set_number(State& s, Session& d, unsigned name, double value) {
  if (name == hd::kUserStatusLight) {
    d.status_light = static_cast<int>(value);
  } else if (!(value >= 0) || !std::isfinite(value)) {
    refuse(s, hd::kInvalidValue, "a limit below zero or not finite", d.handle);
  } else if (name == hd::kSoftwareVelocityLimit) {
    d.velocity_limit = value;
  } else if (name == hd::kSoftwareForceImpulseLimit) {
    d.impulse_limit = value;
  } else {
    d.ramp_time = value;
  }
}

template <class T>
void set(unsigned name, const T* values, Type as) {
  Guard s;
  Session* d = current_session(*s);
  if (!d) return;
  const Parameter* parameter = find_parameter(name);
  if (const unsigned problem = set_problem(*d, script_of(*s, *d), parameter, as)) {
    return refuse(*s, problem, problem == hd::kFrameError ? "hdSet outside a frame" : "hdSet of what cannot be set so",
                  d->handle);
  }
  if (!values) return refuse(*s, hd::kInvalidValue, "hdSet from a null pointer", d->handle);
  Vec v{static_cast<double>(values[0]), 0, 0};
  for (std::size_t i = 1; i < static_cast<std::size_t>(parameter->count) && i < 3; ++i) {
    v[i] = static_cast<double>(values[i]);
  }
  if (!set_vector(*d, name, v)) set_number(*s, *d, name, v[0]);
}

}  // namespace
}  // namespace fakehd

using namespace fakehd;

void hdSetBooleanv(unsigned name, const unsigned char* values) {
  set(name, values, Type::boolean);
}

void hdSetIntegerv(unsigned name, const int* values) {
  set(name, values, Type::integer);
}

void hdSetLongv(unsigned name, const long* values) {
  set(name, values, Type::integer);
}

void hdSetFloatv(unsigned name, const float* values) {
  set(name, values, Type::real);
}

void hdSetDoublev(unsigned name, const double* values) {
  set(name, values, Type::real);
}
