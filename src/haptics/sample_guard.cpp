#include <algorithm>
#include <cmath>

#include "crumble/base/error.hpp"
#include "crumble/haptics/safety.hpp"

namespace crumble {
namespace {

double smaller_known(double ours, double told) noexcept {
  return told > 0 ? std::min(ours, told) : ours;
}

}  // namespace

void check(const SafetyOptions& o) {
  require_positive("safety.max_force", o.max_force);
  require_finite("safety.max_torque", o.max_torque);
  require_in_range("safety.max_torque", o.max_torque, 0, 1e3);
  require_in_range("safety.max_force", o.max_force, 0, 1e3);
  require_positive("safety.max_speed", o.max_speed);
  require_in_range("safety.max_speed", o.max_speed, 0, 10);
  require_positive("safety.max_jump", o.max_jump);
  require_positive("safety.max_slew", o.max_slew);
  require_finite("safety.ramp_time", o.ramp_time);
  require_in_range("safety.ramp_time", o.ramp_time, 0, 60);
  require_positive("safety.workspace_margin", o.workspace_margin);
}

SampleGuard::SampleGuard(const SafetyOptions& options, const DeviceInfo& info, double tick)
    : max_speed_(smaller_known(options.max_speed, info.max_speed)),
      max_jump_(options.max_jump),
      silence_(kStopAge - 0.5 * tick),
      tick_(tick),
      senses_velocity_((info.measured & quantity::kLinearVelocity) != 0),
      filter_(info.position_step) {}

Fault SampleGuard::take(ReadStatus status, const DeviceSample& told, SafetyCounters& counters) noexcept {
  if (status == ReadStatus::lost) return Fault::device_lost;
  waited_ += tick_;
  if (status == ReadStatus::no_new_sample) {
    ++counters.unanswered;
    good_ = waited_ >= silence_ ? 0 : good_;
    return any_ && waited_ >= silence_ ? Fault::silent : Fault::none;
  }
  if (told.flags & sample_flag::kForceOff) return forget(), Fault::driver;
  const Quat& q = told.pose.orientation;
  const bool finite = is_finite(told.pose.position) && std::isfinite(q.w() + q.x() + q.y() + q.z()) &&
                      is_finite(told.linear_velocity) && is_finite(told.angular_velocity);
  if (!finite) return good_ = 0, Fault::not_finite;
  if (!is_valid(told.pose)) return good_ = 0, Fault::bad_pose;
  calibrated_ = !(told.flags & sample_flag::kUncalibrated);
  if (!calibrated_) return forget(), Fault::none;

  if (any_ && jumps(told.pose.position)) {
    good_ = 0;
    if (held_) return Fault::speed;  // no glitch: it is really there
    held_ = true;
    sample_.flags |= sample_flag::kHeld;
    ++counters.held;
    return Fault::none;
  }
  held_ = false;
  sample_ = told;
  sample_.pose = renormalized(told.pose);
  const Vec3 filtered = filter_.take(told.pose.position, waited_);
  velocity_ = senses_velocity_ ? told.linear_velocity : filtered;
  any_ = true;
  waited_ = 0;
  if (!(squared_norm(velocity_) <= max_speed_ * max_speed_)) return good_ = 0, Fault::speed;
  ++good_;
  return Fault::none;
}

// `waited_` has the time since the last one that was believed.
bool SampleGuard::jumps(const Vec3& position) noexcept {
  const double way = norm(position - sample_.pose.position);
  return !(way <= std::min(max_jump_, max_speed_ * waited_ * (1 + 1e-9)));
}

void SampleGuard::forget() noexcept {
  filter_.forget();
  velocity_ = Vec3::Zero();
  good_ = 0, waited_ = 0;
  any_ = held_ = false;
}

}  // namespace crumble
