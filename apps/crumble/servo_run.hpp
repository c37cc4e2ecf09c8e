// A scene in a haptic loop on a thread of its own, watched from here while it runs.
#pragma once

#include <optional>
#include <string>

#include "crumble/base/memory.hpp"
#include "crumble/haptics/loop.hpp"
#include "named_device.hpp"
#include "scenes/scene.hpp"

namespace crumble::app {

struct LoopSettings {
  DeviceChoice device;
  BodyCoupling coupling = BodyCoupling::direct;
  std::uint32_t body_ticks = 1;
  bool body_thread = false;
  std::optional<double> seconds;  // of the loop's time; else until the device's motion is over
  bool virtual_coupling = true, damping = true, controller = false;
  double delay = 0;  // ticks, of a device: see PassivityOptions
  bool record = false;
};

/// What could be seen after one tick.
struct LoopSample {
  double time = 0;                                 // s, by the device's clock
  Pose device;                                     // device frame, m
  Vec3 force = Vec3::Zero(), tool = Vec3::Zero();  // sent, N; in the scene, m
  std::uint32_t contacts = 0;
  std::uint64_t cuts = 0;  // springs cut so far
  HandState state = HandState::waiting;
};

/// A recorded loop run again.
struct LoopReplay {
  std::size_t rows = 0;
  std::optional<std::size_t> first_difference;  // row whose force is another one; none: all have the same bits
  std::uint64_t events = 0, event_hash = 0;     // all events of the run, in order
  std::uint64_t state_hash = 0;                 // after the last row
};

struct LoopRun {
  std::string scene, device, scheduling;
  std::string device_text;    // what the device says is wrong with it
  bool device_drove = false;  // its thread ticked
  LoopSettings settings;
  double seconds = 0;  // that were asked for
  Vector<std::string> warnings;
  Vector<LoopSample> samples;            // about one a millisecond
  double peak_force = 0;                 // N, of the samples; likewise
  double stiffness = 0;                  // N/m that the hand felt at most
  double damping = 0;                    // N s/m injected at most
  LoopStatus status;                     // after the last tick
  HandState state = HandState::waiting;  // before it was stopped
  LoopTimes times;
  std::uint64_t cuts = 0;
  std::optional<Trajectory> trajectory;  // with LoopSettings::record
  std::optional<LoopReplay> replay;      // likewise, where that can be
};

inline constexpr double kMostLoopSeconds = 600;

/// The loop round `device`, whose origin lies at `start`.
LoopDef loop_def(const LoopSettings& settings, const Pose& start, Device& device);

/// Throws Error naming the option and the value.
void check(const LoopSettings& settings);
/// The scene's first tool by the device, whose origin lies where the tool starts; all others stay where they start.
/// Takes as long as the loop does. Throws Error.
LoopRun run_loop(Scene scene, LoopSettings settings);

}  // namespace crumble::app
