// What becomes of fragments: sleep, wake, removal.
#include <algorithm>
#include <string>

#include "crumble/sim/simulation.hpp"

namespace crumble {

void Simulation::track_fragments() noexcept {
  fragments_.cut(new_cuts(), info_.step);
  Event event;
  event.kind = EventKind::split;
  for (const FragmentSplit& split : fragments_.splits()) {
    fragment_states_[split.fragment] = fragment_states_[split.parent];
    counters_.asleep += fragment_states_[split.parent] == FragmentState::asleep;
    event.fragment = split.fragment;
    event.parent = split.parent;
    event.node = split.node;
    event.place = solver_->position(split.node);
    event_log_.add(event);
  }
  if (!fragments_.splits().empty() || regroup_at_ <= info_.step) {
    regroup(info_.step, new_cuts());
  } else if (balls_ && info_.new_cuts > 0) {
    balls_->update(new_cuts(), fragments_.labels(), ball_fragments());
  }
}

FragmentState Simulation::fragment_state(std::uint32_t fragment) const {
  if (fragment >= fragments_.count()) {
    throw Error(Code::out_of_range, "fragment is " + std::to_string(fragment) + ", there are " +
                                        std::to_string(fragments_.count()) + " of them");
  }
  return fragment_states_[fragment];
}

void Simulation::set_fragment_state(std::uint32_t fragment, FragmentState state) {
  const FragmentState now = fragment_state(fragment);
  if (now == FragmentState::removed) {
    throw Error(Code::state, "fragment " + std::to_string(fragment) + " has been removed");
  }
  if (state == now) return;
  if (state == FragmentState::active) wake(fragment);
  if (state == FragmentState::asleep) put_to_sleep(fragment);
  if (state == FragmentState::removed) remove(fragment);
  regroup(last_step(), {});
}

void Simulation::put_to_sleep(std::uint32_t fragment) noexcept {
  fragment_states_[fragment] = FragmentState::asleep;
  ++counters_.asleep;
  for (std::uint32_t node = 0; node < network_.node_count(); ++node) {
    if (fragments_.labels()[node] == fragment) let_sleep(node);
  }
}

void Simulation::let_sleep(std::uint32_t node) noexcept {
  if (network_.fixed[node]) return;
  solver_->set_frozen(node, true);
  contacts_.let_sleep(node);
}

void Simulation::wake(std::uint32_t fragment) noexcept {
  fragment_states_[fragment] = FragmentState::active;
  --counters_.asleep;
  for (std::uint32_t node = 0; node < network_.node_count(); ++node) {
    if (fragments_.labels()[node] != fragment || network_.fixed[node]) continue;
    solver_->set_frozen(node, false);
    contacts_.wake(node);
  }
}

void Simulation::remove(std::uint32_t fragment) noexcept {
  counters_.asleep -= fragment_states_[fragment] == FragmentState::asleep;
  fragment_states_[fragment] = FragmentState::removed;
  ++counters_.removed;
  for (std::uint32_t node = 0; node < network_.node_count(); ++node) {
    if (fragments_.labels()[node] == fragment) take_away(node);
  }
  fragments_.remove(fragment);
}

void Simulation::take_away(std::uint32_t node) noexcept {
  ++counters_.removed_nodes;
  solver_->set_frozen(node, true);
  if (!network_.fixed[node]) contacts_.exclude(node);
}

void Simulation::wake_roused() noexcept {
  bool woken = false;
  for (const std::uint32_t node : contacts_.roused()) {
    const std::uint32_t fragment = fragments_.labels()[node];
    if (fragment_states_[fragment] != FragmentState::asleep) continue;
    wake(fragment);
    ++counters_.woken;
    woken = true;
  }
  if (woken) regroup(last_step(), {});
}

std::span<const std::uint32_t> Simulation::find_debris(const DebrisRule& rule) noexcept {
  for (std::uint32_t f = 0; f < fragments_.count(); ++f) {
    is_debris_[f] = fragment_states_[f] != FragmentState::removed && fragments_.record(f).node_count <= rule.max_nodes;
  }
  for (const NodeConstraint& c : contacts_.constraints()) {
    if (c.holder != kWorldHolder) is_debris_[fragments_.labels()[c.node]] = 0;
  }
  for (std::uint32_t node = 0; node < network_.node_count(); ++node) {
    const std::uint32_t fragment = fragments_.labels()[node];
    if (fragment == kNoFragment || !is_debris_[fragment]) continue;
    is_debris_[fragment] = norm(solver_->velocity(node)) < rule.max_speed;
  }
  debris_.clear();
  for (std::uint32_t f = 0; f < fragments_.count(); ++f) {
    if (is_debris_[f]) debris_.push_back(f);
  }
  return debris_;
}

}  // namespace crumble
