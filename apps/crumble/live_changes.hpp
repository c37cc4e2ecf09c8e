// What a run changes in mid-run: "0.5:stiffness=60".
#pragma once

#include <string>

#include "crumble/base/memory.hpp"
#include "crumble/sim/recording.hpp"

namespace crumble::app {

struct LiveChange {
  double time;  // simulated seconds from which on it holds
  std::string field;
  double value;
};

/// Throws Error: format (not TIME:FIELD=VALUE), unsupported (a field that is not there; the text lists those that are),
/// out_of_range (a time below 0).
LiveChange parse_live_change(const std::string& text);

/// In the order of their times, on a simulation between two steps and in its recording. Throws Error what the
/// definition refuses.
class LiveChanges {
 public:
  explicit LiveChanges(Vector<LiveChange> changes);
  void make_due(Simulation& sim, Recording& recording);

 private:
  Vector<LiveChange> changes_;
  std::size_t next_ = 0;
};

}  // namespace crumble::app
