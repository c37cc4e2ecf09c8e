// Another definition for a body in mid-run: material, gravity, tools, walls, fixed nodes, the way a step is done.
//
// In two halves. The first works the new definition out and takes memory, on any thread; the second stands between two
// steps, on the thread that does them, and takes none, so a servo loop may do it.
#pragma once

#include "crumble/base/memory.hpp"
#include "crumble/sim/simulation.hpp"

namespace crumble {

class DefinitionChange {
 public:
  /// `now`: what the simulation will be of when the change is made. Throws Error what Simulation's constructor throws;
  /// state (what only a new simulation can have: another mesh, precision, tau, iterations, number of tools, or
  /// attachments).
  DefinitionChange(const SimulationDef& now, SimulationDef next);

  /// Once. Positions, velocities, cuts, fragments and contacts stay, and a change to the same definition changes no
  /// bit. A tool whose solid or offset is another one lets go and, like one that begins inside the body, touches
  /// nothing until it has been outside; nodes that walls hold are let go when walls have moved, and met again. A node
  /// that becomes fixed stops where it is. Snapshots from before no longer fit. Part of the state, so a recording has
  /// to know of it. Takes time in proportion to the body; no memory.
  void apply_to(Simulation& sim) noexcept;

  const SimulationDef& definition() const noexcept { return next_.def_; }

 private:
  Simulation next_;                   // afterwards: what is no longer needed
  Vector<std::uint8_t> moved_tools_;  // 1: another solid or offset (by tool)
  bool moved_walls_;
};

}  // namespace crumble
