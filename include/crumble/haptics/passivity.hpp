// Energy at the hand: how much goes each way, and damping against what sampling makes of a spring.
//
// A spring of stiffness K whose force is held for a tick T, averaged over N ticks and late by d gives back more than it
// took, up to K T (N/2 + d) |v|^2 a second: it acts like a negative damper of that size (Colgate and Schenkel, J.
// Robotic Systems 14, 1997, for N = 1, d = 0). Injected damping makes up for it. That is an aid to stability; the
// observer is the proof.
#pragma once

#include <array>

#include "crumble/base/vec.hpp"
#include "crumble/device/device.hpp"

namespace crumble {

inline constexpr double kMostDelay = 64;  // ticks

struct PassivityOptions {
  bool inject_damping = true;
  double delay = 1;        // d, ticks from a sample to its force in the motors, the hold not counted; [0, kMostDelay]
  double max_damping = 0;  // N s/m that may be injected; 0: the device's max_damping, 5 where it tells none
  bool controller =
      false;  // Hannaford and Ryu, IEEE Trans. Robotics Autom. 18, 2002: brakes when the ledger is in debt
  double energy_credit = 0.02;  // J: what the controller lets come back of all that went in; > 0
};

/// Throws Error naming passivity.FIELD: invalid_value, out_of_range.
void check(const PassivityOptions& options);

/// Mass assumed for a device that tells none, kg.
inline constexpr double kUnknownMass = 0.05;

/// The most that may be injected: max_damping as above, and no more than a held force can brake without turning the
/// device back, half its mass over a tick. N s/m.
double damping_limit(const PassivityOptions& options, const DeviceInfo& info, double tick) noexcept;

/// K T (N/2 + d): symmetric as K. N s/m; `mean` is N.
Mat3 needed_damping(const Mat3& stiffness, double tick, double mean, double delay) noexcept;
/// Of a symmetric matrix that is never negative: no smaller than its greatest eigenvalue, and equal to it for multiples
/// of the identity. The greatest sum of a row's sizes.
double size_of(const Mat3& m) noexcept;

/// What has passed between loop and hand, J. Exact for a force that is held from tick to tick and comes
/// PassivityOptions:: delay ticks late; encoder steps let it look less than it is (docs/haptics.md).
struct HandEnergy {
  double absorbed = 0;    // by the loop: - sum of F . dx of the force sent. Never below what was stored at the start
  double least = 0;       // of `absorbed`, ever: the proof
  double injected = 0;    // of it, taken by injected damping
  double controlled = 0;  // of it, taken by the controller
  double credit = 0;      // what the controller goes by: `absorbed`, but never above energy_credit
  double required_damping = 0;  // N s/m: the most that was needed at any time, whatever was allowed
};

/// Counts what the forces that were sent do from tick to tick.
class EnergyObserver {
 public:
  explicit EnergyObserver(const PassivityOptions& options);

  /// What goes to the hand, N, and which parts of it are brakes.
  struct Sent {
    Vec3 force = Vec3::Zero(), damping = Vec3::Zero(), control = Vec3::Zero();
  };

  /// The device is at `position` (m) now: once a tick, before sent().
  void moved(const Vec3& position) noexcept;
  void sent(const Sent& sent) noexcept;
  /// Damping (N s/m) that the stiffness calls for now.
  void required(double damping) noexcept;
  /// Force of the controller, at `velocity` (m/s), to be added: a brake of at most `limit` N s/m that pays the debt in
  /// one tick; zero without one.
  Vec3 brake(const Vec3& velocity, double tick, double limit) const noexcept;
  /// The next position is the first.
  void forget_position() noexcept { placed_ = false; }

  const HandEnergy& energy() const noexcept { return energy_; }

 private:
  HandEnergy energy_;
  Vec3 position_ = Vec3::Zero();
  std::array<Sent, static_cast<std::size_t>(kMostDelay) + 1> sent_{};  // the newest at newest_
  std::size_t newest_ = 0, delay_;
  double most_credit_;
  bool placed_ = false;
};

}  // namespace crumble
