// One hand in the loop: its device, its tool, and all that stands between.
//
//   device -> SampleGuard -> workspace, clutch -> VirtualCoupling -> tool
//   device <- ForceGuard <- controller <- damping <- workspace <-     force
#pragma once

#include <atomic>

#include "haptics/body_link.hpp"

namespace crumble::haptics {

/// What other threads ask of a hand.
struct HandRequests {
  std::atomic<Fault> fault{Fault::none};  // to latch
  std::atomic<bool> reset{false};
};

class HandChannel {
 public:
  /// `def` has been checked. `mean`: ticks that the body's force is a mean of or is held; `full_age`: s.
  HandChannel(const HandDef& def, double tick, double mean, double full_age);

  std::uint32_t holder() const noexcept { return def_.holder; }
  const Pose& tool() const noexcept { return tool_; }

  // One tick, in this order

  /// Where the hand is.
  void sense(HandRequests& requests) noexcept;
  /// Where that puts the tool; `answer` is the body's to where it was.
  const Pose& move_tool(const Answer& answer) noexcept;
  /// The tool must not touch the body now.
  bool suspended() const noexcept;
  /// What the hand feels.
  void feel(const Answer& answer, double age, Code body, std::uint64_t order) noexcept;

  /// Zero force, and waiting as at the beginning.
  void release() noexcept;
  /// Zero force, whatever the state; by the watchdog too.
  void take_force_away() noexcept;
  void report(HandStatus& out) const noexcept;

 private:
  void latch(Fault fault) noexcept;
  void wait_again() noexcept;
  void watch_clutch() noexcept;
  void follow_hand() noexcept;
  void let_in(const Answer& answer) noexcept;
  bool touches(const Answer& answer) const noexcept;
  EnergyObserver::Sent push(const Answer& answer, double age) noexcept;
  Mat3 damping_for(const Mat3& stiffness, double mean) noexcept;
  void send(const Vec3& force, const Vec3& torque) noexcept;

  HandDef def_;
  DeviceInfo info_;
  double tick_, mean_;
  Workspace workspace_;
  SampleGuard samples_;
  ForceGuard forces_;
  VirtualCoupling coupling_;
  EnergyObserver energy_;
  double most_damping_;

  HandState state_ = HandState::waiting;
  Fault fault_ = Fault::none;
  bool finished_ = false;
  std::uint64_t free_since_ = 0;  // order from which on the tool may touch; 0: it may not
  Vec3 shift_ = Vec3::Zero();     // of the clutch, scene, m
  Pose scene_;                    // device in the scene, with the shift
  Pose tool_;
  Wrench body_;
  std::uint32_t contacts_ = 0;
  Vec3 force_ = Vec3::Zero(), torque_ = Vec3::Zero();
  double stiffness_ = 0, damping_ = 0;
  SafetyCounters counters_;
};

}  // namespace crumble::haptics
