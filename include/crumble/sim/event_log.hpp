// The events of one step, in memory that was taken before.
#pragma once

#include <cstdint>
#include <span>

#include "crumble/base/memory.hpp"
#include "crumble/base/reserved_vector.hpp"
#include "crumble/sim/event.hpp"
#include "crumble/tetmesh/node_constraint.hpp"

namespace crumble {

class EventLog {
 public:
  /// `capacity`: events of one step.
  EventLog(std::size_t node_count, std::size_t capacity);

  /// Forgets the events of the step before. `step` counts from 0, `time` is at its end, seconds.
  void begin_step(std::uint64_t step, double time) noexcept;
  /// Fills in step and time. What does not fit is counted and dropped.
  void add(Event event) noexcept;
  /// At the end of a step: compares who holds which node with the step before. Each node has one holder at most; a
  /// change of holder is a beginning and an end. `complete(event, constraint or null)` fills in what we do not know.
  template <class Complete>
  void add_contacts(std::span<const NodeConstraint> held, Complete&& complete) noexcept {
    for (const NodeConstraint& c : held) {
      if (is_new(c)) add_contact(EventKind::contact_begin, c.node, c.holder, [&](Event& e) { complete(e, &c); });
    }
    for (const auto& [node, holder] : touches_) {
      if (ended(node, holder)) {
        add_contact(EventKind::contact_end, node, holder, [&](Event& e) { complete(e, nullptr); });
      }
    }
    list_touches(held);
  }
  /// After a reset or a restore to `steps` done: what is held now has been held.
  void restart(std::uint64_t steps, std::span<const NodeConstraint> held) noexcept;

  std::span<const Event> events() const noexcept { return events_; }
  /// In the present step.
  std::uint64_t dropped() const noexcept { return dropped_; }

 private:
  static constexpr std::uint64_t kNever = ~std::uint64_t{0};
  struct Touch {
    std::uint32_t node, holder;
  };
  struct LastTouch {
    std::uint32_t holder = 0;
    std::uint64_t steps = kNever;  // that were done when it last held the node
  };

  template <class Fill>
  void add_contact(EventKind kind, std::uint32_t node, std::uint32_t holder, Fill&& fill) noexcept {
    Event event;
    event.kind = kind;
    event.node = node;
    event.holder = holder;
    fill(event);
    add(event);
  }
  bool is_new(const NodeConstraint& held) noexcept;
  bool ended(std::uint32_t node, std::uint32_t holder) const noexcept;
  void list_touches(std::span<const NodeConstraint> held) noexcept;

  ReservedVector<Event> events_;
  std::uint64_t dropped_ = 0, step_ = 0;
  double time_ = 0;
  ReservedVector<Touch> touches_;   // at the end of the last step
  Vector<LastTouch> last_touches_;  // of each node
};

}  // namespace crumble
