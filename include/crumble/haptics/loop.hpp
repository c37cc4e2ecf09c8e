// The haptic loop: devices on one side, a simulation on the other, and between them all that makes a force fit for a
// hand. src/haptics/tick.cpp is the file to read first; docs/haptics.md is for those who tune.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>

#include "crumble/base/memory.hpp"
#include "crumble/device/device.hpp"
#include "crumble/device/workspace.hpp"
#include "crumble/haptics/status.hpp"
#include "crumble/haptics/virtual_coupling.hpp"
#include "crumble/sim/publisher.hpp"
#include "crumble/sim/recording.hpp"
#include "crumble/sim/simulation.hpp"

namespace crumble {

/// How a tick gets its force from the body.
enum class BodyCoupling : std::uint8_t {
  direct = 0,       // the body is stepped in the tick
  local_model = 1,  // it is stepped every body_ticks, and its local model answers in between
  paper = 2,        // the same, with the mean of its last five forces (Eq 7), held in between
};

/// One device that moves one tool.
struct HandDef {
  Device* device = nullptr;  // borrowed; must outlive the loop
  std::uint32_t holder = 0;  // tool that it moves; behind the tools, attachment
  WorkspaceOptions workspace;
  std::uint32_t clutch_buttons = 0;  // while any of these is down, the tool stays and the hand moves freely; 0: none
  CouplingOptions coupling;
  PassivityOptions passivity;
  SafetyOptions safety;
};

enum class LoopDriver : std::uint8_t {
  own_thread = 0,  // start() makes one
  device = 1,      // start() hands the tick to the first servo_driven device
  host = 2,        // whoever calls tick()
  automatic = 3,   // device if there is such a device, else own_thread
};

struct ThreadOptions {
  int priority = 80;  // of SCHED_FIFO; 0: as the system likes. Not allowed is no error, see HapticLoop::realtime()
  bool lock_memory = false;  // mlockall: of the whole process
  int processor = -1;        // to stay on; -1: any
};

struct LoopDef {
  double tick = 1e-3;  // s, of the servo: [1e-4, 0.01]
  BodyCoupling coupling = BodyCoupling::direct;
  std::uint32_t body_ticks = 1;  // local_model, paper: ticks to a step of the body, [1, 100]. The simulation's step
                                 // has to take tick * body_ticks (direct: tick)
  bool body_thread = false;  // local_model, paper: the body has its own thread; else every body_ticks-th tick steps it
  LoopDriver driver = LoopDriver::automatic;
  bool watchdog = true;  // a thread that takes the force away when ticks stay out for kStopAge; from start() to stop().
                         // Where the device drives, none but its own driver can: the hand is faulted, no more
  ThreadOptions thread;
  Vector<HandDef> hands;  // one to kMaxHands
};

/// The paper's choices: Eq (7)'s mean, held; nothing between body and hand but the safety stages.
void apply_paper_preset(LoopDef& def);

class HapticLoop {
 public:
  /// `sim` and the devices are borrowed. Throws Error naming the field: null, empty, invalid_value, out_of_range,
  /// bad_pose, too_large (more than kMaxHands), state (a holder that two hands move), unsupported (no device drives);
  /// and what start_servo throws. A servo_driven device that does not drive is run as a PolledDevice from here on, but
  /// where its servo_group drives; that makes its force one tick late, and PassivityOptions::delay counts it.
  HapticLoop(Simulation& sim, LoopDef def);
  ~HapticLoop();  // stops
  HapticLoop(const HapticLoop&) = delete;
  HapticLoop& operator=(const HapticLoop&) = delete;

  const LoopDef& definition() const noexcept;
  /// What in the definition is not as it should be, in words: damping that the device cannot bear, ...
  const Vector<std::string>& warnings() const noexcept;

  // Before start(), or while stopped

  /// Moves a holder that no hand moves; where they have not been placed they stay at the origin's pose.
  /// Throws Error: out_of_range (no such holder), state (a hand moves it, or the loop runs), bad_pose.
  void place(std::size_t holder, const Pose& pose);
  /// Told after each step; borrowed. Several may be added; throws Error(state) while running.
  void publish_to(StatePublisher& publisher);
  /// None is told any more. Throws Error(state) while running.
  void forget_publishers();
  /// Keeps the inputs of each step. Allocates in ticks. nullptr: no more. Throws Error(state) while running.
  void record_to(Recording* recording);
  /// Begins to tick; hands wait as at the beginning. Throws Error: state (runs already), internal (no thread), and what
  /// the device throws.
  void start();
  /// One tick, by the host's thread: driver `host`, with or without start(). Does not allocate (but see record_to),
  /// lock, throw or call the system.
  void tick() noexcept;

  // Any thread

  /// Returns when the last tick is over and every device has been sent zero. May be called again.
  void stop() noexcept;
  bool running() const noexcept;
  LoopStatus status() const noexcept;
  LoopTimes times() const noexcept;
  /// "SCHED_FIFO 80", or why not; empty where the thread is not ours.
  std::string realtime() const;
  /// Another definition of the simulation, while the loop runs: `edit` gets what the last change led to. It is worked
  /// out here, in as long as a simulation takes to make, and made between two steps, the oldest first, one per step;
  /// stop() makes those that wait. Throws Error: what DefinitionChange throws; state (the loop does not run, or 64
  /// wait).
  void change(const std::function<void(SimulationDef&)>& edit);
  /// No force on any hand from the next tick on, until its fault is reset.
  void halt() noexcept;
  /// A hand that is faulted waits again, as at the beginning, and gets its force back by the ramp. Of another: nothing.
  void reset_fault(std::size_t hand) noexcept;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace crumble
