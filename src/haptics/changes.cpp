#include "haptics/changes.hpp"

#include <string>

namespace crumble::haptics {

Changes::~Changes() {
  while (Change* const change = take()) delete change;
  throw_done_away();
}

void Changes::open(const SimulationDef& now) {
  const std::lock_guard lock(mutex_);
  latest_ = now;
  open_ = true;
}

void Changes::close() {
  const std::lock_guard lock(mutex_);
  open_ = false;
}

void Changes::add(const std::function<void(SimulationDef&)>& edit) {
  const std::lock_guard lock(mutex_);
  if (!open_) throw Error(Code::state, "the loop does not run");
  throw_done_away();
  if (out_ == kMost) {
    throw Error(Code::state, std::to_string(kMost) + " changes wait for a step: the body does not answer");
  }
  SimulationDef next = latest_;
  edit(next);
  auto change = std::make_unique<Change>(Change{{}, DefinitionChange(latest_, next), Recording::settings_of(next)});
  latest_ = std::move(next);
  waiting_.push(change.release());
  ++out_;
}

Change* Changes::take() noexcept {
  std::array<Change*, 1> oldest;
  return waiting_.pop(oldest) == 1 ? oldest[0] : nullptr;
}

void Changes::throw_done_away() noexcept {
  std::array<Change*, 1> oldest;
  for (; done_.pop(oldest) == 1; --out_) delete oldest[0];
}

}  // namespace crumble::haptics
