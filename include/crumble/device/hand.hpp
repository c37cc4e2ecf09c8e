// A simulated hand that holds a simulated device: the one scripted device that feels the force, so that a loop can be
// closed without a person.
#pragma once

#include <array>
#include <memory>

#include "crumble/base/memory.hpp"
#include "crumble/device/device.hpp"

namespace crumble {

/// Where the hand wants to be. Between two points it moves on the straight line of least jerk (Flash and Hogan, J.
/// Neurosci. 5, 1985), at rest in both.
struct HandPoint {
  double time = 0;           // s, from 0 on, increasing from point to point
  Vec3 move = Vec3::Zero();  // m, from where it started
};

/// m x'' = k (wanted - x) - b x' - f sign(x') + F: hand and device as one mass on a spring and a damper, as a grip is.
/// x is wanted at time 0, before the first point. The orientation stays.
struct HandOptions {
  Pose start = {};             // m, device frame
  Vector<HandPoint> points;    // one at least
  double mass = 0.1;           // m, kg, of hand and device; > 0
  double stiffness = 50;       // k, N/m, of the grip; >= 0
  double damping = 0.5;        // b, N s/m, of both; >= 0
  double friction = 0;         // f, N, dry friction in the device; >= 0
  double encoder_step = 0;     // m: positions are told in whole steps of it, along each axis; 0: as they are
  std::uint32_t delay = 0;     // ticks between a write and its force; at most kMaxDelay
  double device_mass = 0.075;  // kg, of the device alone, as its info tells; (0, mass]
  double max_force = 3.3;      // N, of its motors: the norm of what is written is clamped to it; > 0
  double max_stiffness = 0;    // N/m and
  double max_damping = 0;      // N s/m, as its info tells; 0: it does not

  static constexpr std::uint32_t kMaxDelay = 64;
};

/// Step-locked: read k (from 0) gives time k * tick; what is written is in force from then to the next read, or `delay`
/// ticks later. Finished when the last point has been reached; it goes on feeling the force, and moving by it.
class SimulatedHand final : public Device {
 public:
  /// Throws Error naming the field of `hand`: bad_pose, empty, invalid_value, out_of_range; or the tick. Out of range
  /// is also a mass too small for the stiffness and damping to be integrated in a 64th of a tick.
  SimulatedHand(const HandOptions& options, double tick);

  const DeviceInfo& info() const noexcept override { return info_; }
  [[nodiscard]] ReadStatus read(DeviceSample& sample) noexcept override;
  void write(const Vec3& force, const Vec3& torque) noexcept override;

  // What no encoder tells, at the time of the last read
  const Vec3& position() const noexcept { return position_; }  // m, device frame
  const Vec3& velocity() const noexcept { return velocity_; }  // m/s
  /// Integral of - F . v dt, J: what the other side has taken from this one. Exact: F changes with the ticks only.
  double energy_given() const noexcept { return energy_given_; }

 private:
  Vec3 wanted(double time) const noexcept;
  void advance() noexcept;

  DeviceInfo info_;
  HandOptions options_;
  double tick_;
  std::uint64_t count_ = 0;  // reads
  Vec3 position_, velocity_ = Vec3::Zero();
  std::array<Vec3, HandOptions::kMaxDelay + 1> forces_;  // written, by tick modulo
  double energy_given_ = 0;
};

/// The same as any other device.
std::unique_ptr<Device> open_hand(const HandOptions& options, double tick);

}  // namespace crumble
