// What a drawing, listening or logging thread sees of a simulation that another thread steps.
//
// The stepping thread calls publish() after each step. Most of these calls only look at a flag: a state is copied when
// the reader has asked for one, and never more than kStatesPerSecond of them in a simulated second, counted in steps,
// so that a reader that asks without pause costs no more than one that draws.
//
// A copy may not cost more than a small part of the step that it follows. It costs about 3 ns a node, a third of what
// the node's own step costs (half of a body of 57 000 springs: 13 us, beside a step of 72 us), and sixty steps in a
// thousand would have it in their p99. So a body of more than kWholeNodes nodes is copied in up to sixteen slices, one
// per step, which still makes sixty states a second, and one of more than 16 kNodesPerTick nodes in more: a slice of
// 8192 nodes takes 26 us beside the 1.4 ms that a step of a million springs takes.
//
// Such a state is a few steps old at one end and new at the other (first_step, step). Nodes are in order of their
// numbers, which follow the body's rows, so a seam is a plane through the body, where neighbours are drawn as much too
// far apart as they move in a step. Cuts and labels have seams too: of a spring that has just broken the nodes may
// still carry the old fragment, or the spring may look whole between two fragments. The next state has mended it.
// Bodies of up to kWholeNodes nodes are always of one step, to the bit.
#pragma once

#include <cstdint>
#include <span>

#include "crumble/base/latest_value.hpp"
#include "crumble/base/memory.hpp"
#include "crumble/base/ring.hpp"
#include "crumble/base/vec_array.hpp"
#include "crumble/sim/event.hpp"
#include "crumble/sim/simulation.hpp"

namespace crumble {

/// A copy of what changes in a simulation.
struct PublishedState {
  std::uint64_t first_step = 0;           // steps done when the copy was begun, and
  std::uint64_t step = 0;                 // when it was complete: the same but for large bodies
  double time = 0;                        // simulated seconds, of `step`
  Counters counters;                      // of `step`
  VecArray positions;                     // metres (node_count)
  Vector<std::uint8_t> intact;            // 1 intact, 0 cut (spring_count)
  Vector<std::uint32_t> fragments;        // see Simulation::node_fragments (node_count)
  std::size_t fragment_count = 0;         // ids given so far: those above are all below it
  Vector<FragmentRecord> records;         // by id (fragment_count; room for node_count)
  Vector<FragmentState> fragment_states;  // the same
};

/// From one stepping thread to one reading thread; which thread that is may change while none is in a call. Nothing
/// here but construction waits, locks, allocates, throws or calls the system.
class StatePublisher {
 public:
  static constexpr std::uint32_t kStatesPerSecond = 60;
  static constexpr std::size_t kWholeNodes = 1024;    // bodies up to this are copied by one publish()
  static constexpr std::size_t kNodesPerTick = 8192;  // no publish() copies more
  static constexpr std::size_t kEvents = 16384;       // that can wait for the reader

  /// Takes all memory for bodies like this one. latest() is the state that `sim` is in.
  explicit StatePublisher(const Simulation& sim);

  // The stepping thread; `sim` is the one given at construction, or a copy of it

  /// After each step: passes its events on and, when the reader has asked, copies the state or the next slice of it.
  /// A copy that was begun before a reset, or before a restore to an earlier step or to fewer fragments, is begun
  /// again.
  void publish(const Simulation& sim) noexcept;
  /// The whole state at once, asked or not; passes no events on. For programs with one thread, and after a restore.
  void publish_now(const Simulation& sim) noexcept;

  // The reading thread

  /// The newest complete state, and a wish for the next. Valid until the next call.
  const PublishedState& latest() noexcept;
  /// Takes the oldest events that have not been read, as many as wait and fit. Returns how many.
  std::size_t read_events(std::span<Event> out) noexcept { return events_.pop(out); }
  /// Events that found kEvents others waiting. Any thread.
  std::uint64_t events_dropped() const noexcept { return events_.dropped(); }

 private:
  bool is_due(const Simulation& sim) const noexcept;
  void copy_slice(const Simulation& sim) noexcept;
  void copy_records(const Simulation& sim) noexcept;

  LatestValue<PublishedState> states_;
  Ring<Event> events_;
  // the stepping thread's
  std::size_t slices_;           // that a state is copied in
  std::size_t slice_ = 0;        // next one; 0: no copy has been begun
  std::uint64_t last_step_ = 0;  // at the last publish, with
  std::size_t last_fragment_count_ = 0;
  std::uint64_t frame_ = 0;  // of 1 / kStatesPerSecond of simulated time, in which the last copy was begun
};

}  // namespace crumble
