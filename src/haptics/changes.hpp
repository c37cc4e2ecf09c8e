// Changes of a simulation's definition on their way from any thread to the one that steps, and back to be thrown away:
// so the stepping thread neither takes memory nor gives any back, and nobody waits for it.
#pragma once

#include <array>
#include <functional>
#include <memory>
#include <mutex>

#include "crumble/base/ring.hpp"
#include "crumble/sim/change.hpp"
#include "crumble/sim/recording.hpp"

namespace crumble::haptics {

struct Change : Allocated {
  DefinitionChange definition;
  Vector<std::uint8_t> settings;  // for a recording
};

class Changes {
 public:
  static constexpr std::size_t kMost = 64;  // that wait

  Changes() : waiting_(kMost), done_(kMost) {}
  ~Changes();

  // Any thread

  /// From here on the simulation is of `now`, and changes are taken.
  void open(const SimulationDef& now);
  /// Throws Error: what DefinitionChange throws; state (not open, or kMost wait for a step).
  void add(const std::function<void(SimulationDef&)>& edit);
  /// No more changes are taken; those that wait are left to take().
  void close();

  // The stepping thread, or who closes, when it is no more

  /// The oldest that waits, for give_back() when it has been made; nullptr: none waits.
  Change* take() noexcept;
  void give_back(Change* change) noexcept { done_.push(change); }

 private:
  void throw_done_away() noexcept;

  std::mutex mutex_;  // of what follows, and of both rings' ends on this side
  bool open_ = false;
  SimulationDef latest_;  // that the last change led to
  std::size_t out_ = 0;   // changes that have not come back
  Ring<Change*> waiting_, done_;
};

}  // namespace crumble::haptics
