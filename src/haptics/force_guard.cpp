#include <algorithm>
#include <cmath>

#include "crumble/haptics/safety.hpp"

namespace crumble {
namespace {

// Warm motors (OpenHaptics' own example of preventing warm motors has the same numbers): from 0.7 on the cap sinks,
// below 0.5 it rises again, by 1 a second of itself.
constexpr double kHot = 0.7, kCool = 0.5, kHeatRate = 1;
constexpr double kUnknownContinuous = 0.3;  // of the peak
constexpr double kFadeTime = 0.02;          // s in which a clutch takes the force away

void scale_to(Vec3& force, double size, double most) noexcept {
  if (size > most) force *= most / size;
}

}  // namespace

ForceGuard::ForceGuard(const SafetyOptions& options, const DeviceInfo& info, double tick, double full_age)
    : options_(options),
      tick_(tick),
      full_age_(std::min(full_age, kStopAge)),
      peak_(info.max_force > 0 ? std::min(options.max_force, info.max_force) : options.max_force),
      continuous_(std::min(peak_, info.continuous_force > 0 ? info.continuous_force : kUnknownContinuous * peak_)),
      max_torque_(std::min(options.max_torque, info.max_torque)),
      low_(info.workspace_low),
      high_(info.workspace_high),
      cap_(peak_) {}

Fault ForceGuard::pass(Order& order, SafetyCounters& counters) noexcept {
  if (!is_finite(order.force) || !is_finite(order.torque)) {
    order.force = order.torque = Vec3::Zero();
    drop();
    return Fault::not_finite;
  }
  move_ramp(order.let_in);
  const double share = share_of_age(order.age, counters) * share_of_workspace(order.position, counters) * ramp_;
  order.force *= share;
  order.torque *= share;
  heat(order.heat);
  clamp(order.force, counters);
  const double rise = options_.max_slew / peak_ * max_torque_ * tick_;  // of the torque: in the same time
  scale_to(order.torque, norm(order.torque), std::min(max_torque_, last_torque_ + rise));
  return Fault::none;
}

void ForceGuard::drop() noexcept {
  ramp_ = last_ = last_torque_ = 0;
}

void ForceGuard::sent(const Vec3& force, const Vec3& torque) noexcept {
  last_ = norm(force);
  last_torque_ = norm(torque);
}

void ForceGuard::clamp(Vec3& force, SafetyCounters& counters) const noexcept {
  const double size = norm(force);
  counters.clamped += size > cap_;
  counters.heated += size > cap_ && cap_ < peak_;
  scale_to(force, size, cap_);
  const double most = last_ + options_.max_slew * tick_, left = std::min(size, cap_);
  counters.slewed += left > most;
  scale_to(force, left, most);
}

double ForceGuard::share_of_age(double age, SafetyCounters& counters) const noexcept {
  if (age <= full_age_) return 1;
  ++counters.aged;
  return age < kStopAge ? (kStopAge - age) / (kStopAge - full_age_) : 0;
}

double ForceGuard::share_of_workspace(const Vec3& position, SafetyCounters& counters) const noexcept {
  if (low_ == high_) return 1;
  double out = 0;
  for (int axis = 0; axis < 3; ++axis) {
    out = std::max({out, low_[axis] - position[axis], position[axis] - high_[axis]});
  }
  if (out <= 0) return 1;
  ++counters.outside;
  return std::max(0.0, 1 - out / options_.workspace_margin);
}

void ForceGuard::move_ramp(bool let_in) noexcept {
  if (let_in) {
    ramp_ = options_.ramp_time > tick_ ? std::min(1.0, ramp_ + tick_ / options_.ramp_time) : 1;
  } else {
    ramp_ = std::max(0.0, ramp_ - tick_ / kFadeTime);
  }
}

void ForceGuard::heat(double temperature) noexcept {
  if (temperature > kHot) hot_ = true;
  if (temperature < kCool) hot_ = false;
  cap_ += (hot_ ? -cap_ : cap_) * (kHeatRate * tick_);
  cap_ = std::clamp(cap_, continuous_, peak_);
}

}  // namespace crumble
