// What stands between a device and the rest, in both directions and for every device: samples are looked at before
// anything believes them, and no force reaches a hand but through force().
//
// The order of stages is fixed: finite, jump, speed | body | age, workspace, ramp, norm and heat, slew. A fault makes
// the force zero at once, past the slew.
#pragma once

#include <cstdint>

#include "crumble/device/device.hpp"
#include "crumble/haptics/fault.hpp"
#include "crumble/haptics/velocity_filter.hpp"

namespace crumble {

/// Forces and torques as the device feels them. A device's own smaller limits come first.
struct SafetyOptions {
  double max_force = 3;              // N; > 0
  double max_torque = 0.1;           // N m; >= 0
  double max_speed = 1;              // m/s of the device; > 0. Above it the hand is let go
  double max_jump = 5e-3;            // m between two samples; > 0. A longer one is held back for a tick
  double max_slew = 300;             // N/s: how fast the force may grow; > 0. It may fall at once
  double ramp_time = 0.5;            // s in which it comes in after start, clutch and reset; >= 0
  std::uint32_t good_samples = 100;  // in a row before that
  double workspace_margin = 0.01;    // m outside the device's workspace over which the force goes to 0; > 0
};

/// An answer of the body as old as that, or a device that has told nothing for so long, is a fault, s. From two steps
/// of the body on to here the force fades.
inline constexpr double kStopAge = 0.02;

/// Throws Error naming safety.FIELD: invalid_value, out_of_range.
void check(const SafetyOptions& options);

/// How often a stage had to do something.
struct SafetyCounters {
  std::uint64_t held = 0;        // samples: a jump, the pose before it stood for one tick
  std::uint64_t aged = 0;        // ticks in which the body's answer was old
  std::uint64_t outside = 0;     // ticks outside the workspace
  std::uint64_t clamped = 0;     // ticks in which the norm was clamped
  std::uint64_t heated = 0;      // ticks in which warm motors took force away
  std::uint64_t slewed = 0;      // ticks in which the force would have grown too fast
  std::uint64_t capped = 0;      // ticks in which injected damping would have been more than the device bears
  std::uint64_t faults = 0;      // latched
  std::uint64_t unanswered = 0;  // ticks for which the device had no new sample
};

/// Towards the scene: believes samples, or says why not.
class SampleGuard {
 public:
  /// `tick`: s between two calls.
  SampleGuard(const SafetyOptions& options, const DeviceInfo& info, double tick);

  /// Looks at what a read() gave. Fault::none: sample() and velocity() are good.
  Fault take(ReadStatus status, const DeviceSample& told, SafetyCounters& counters) noexcept;
  /// The last one believed, its orientation made unit.
  const DeviceSample& sample() const noexcept { return sample_; }
  /// m/s, device frame: the device's own if it senses one, else by the filter.
  const Vec3& velocity() const noexcept { return velocity_; }
  /// The device knows where it is.
  bool calibrated() const noexcept { return calibrated_; }
  /// Good samples in a row.
  std::uint64_t good() const noexcept { return good_; }
  /// Believes the next one, wherever it is.
  void forget() noexcept;

 private:
  bool jumps(const Vec3& position) noexcept;

  double max_speed_, max_jump_, silence_, tick_;
  bool senses_velocity_;
  VelocityFilter filter_;
  DeviceSample sample_{};
  Vec3 velocity_ = Vec3::Zero();
  double waited_ = 0;  // s since the last one
  std::uint64_t good_ = 0;
  bool any_ = false, held_ = false, calibrated_ = false;
};

/// Towards the hand.
class ForceGuard {
 public:
  /// `full_age`: s up to which an answer is fresh.
  ForceGuard(const SafetyOptions& options, const DeviceInfo& info, double tick, double full_age);

  struct Order {
    Vec3 force = Vec3::Zero(), torque = Vec3::Zero();  // N, N m, device frame: what is wanted
    double age = 0;                                    // s of the body's answer
    Vec3 position = Vec3::Zero();                      // m, device frame
    double heat = 0;                                   // DeviceSample::motor_temperature
    bool let_in = false;                               // the ramp goes up; else down
  };
  /// Makes of `order` what may be sent. Not finite in: a fault, and zero out.
  Fault pass(Order& order, SafetyCounters& counters) noexcept;
  /// Norm, heat and slew once more: for what was put on top.
  void clamp(Vec3& force, SafetyCounters& counters) const noexcept;
  /// What has been sent: the next force grows from there.
  void sent(const Vec3& force, const Vec3& torque) noexcept;
  /// Zero has been sent, and the ramp begins anew.
  void drop() noexcept;

  double ramp() const noexcept { return ramp_; }
  double cap() const noexcept { return cap_; }  // N, now

 private:
  double share_of_age(double age, SafetyCounters& counters) const noexcept;
  double share_of_workspace(const Vec3& position, SafetyCounters& counters) const noexcept;
  void move_ramp(bool let_in) noexcept;
  void heat(double temperature) noexcept;

  SafetyOptions options_;
  double tick_, full_age_, peak_, continuous_, max_torque_;
  Vec3 low_, high_;  // of the workspace; equal: none
  double ramp_ = 0, cap_, last_ = 0, last_torque_ = 0;
  bool hot_ = false;
};

}  // namespace crumble
