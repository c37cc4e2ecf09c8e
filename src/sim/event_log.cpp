#include "crumble/sim/event_log.hpp"

#include <algorithm>
#include <utility>

namespace crumble {

static_assert(Event::kNone == kWorldHolder);

EventLog::EventLog(std::size_t node_count, std::size_t capacity) : last_touches_(node_count) {
  events_.reserve(capacity);
  touches_.reserve(node_count);
}

void EventLog::begin_step(std::uint64_t step, double time) noexcept {
  events_.clear();
  dropped_ = 0;
  step_ = step;
  time_ = time;
}

void EventLog::add(Event event) noexcept {
  if (events_.size() == events_.capacity()) {
    ++dropped_;
    return;
  }
  event.step = step_;
  event.time = time_;
  events_.push_back(event);
}

bool EventLog::is_new(const NodeConstraint& held) noexcept {
  const LastTouch last = std::exchange(last_touches_[held.node], {held.holder, step_ + 1});
  return last.steps != step_ || last.holder != held.holder;
}

bool EventLog::ended(std::uint32_t node, std::uint32_t holder) const noexcept {
  return last_touches_[node].steps != step_ + 1 || last_touches_[node].holder != holder;
}

void EventLog::list_touches(std::span<const NodeConstraint> held) noexcept {
  touches_.clear();
  for (const NodeConstraint& c : held) touches_.push_back({c.node, c.holder});
}

void EventLog::restart(std::uint64_t steps, std::span<const NodeConstraint> held) noexcept {
  events_.clear();
  std::fill(last_touches_.begin(), last_touches_.end(), LastTouch{});
  for (const NodeConstraint& c : held) last_touches_[c.node] = {c.holder, steps};
  list_touches(held);
}

}  // namespace crumble
