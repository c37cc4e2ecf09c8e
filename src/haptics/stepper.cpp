#include "haptics/body_link.hpp"

namespace crumble::haptics {

void Stepper::step(std::span<const Pose> poses, HandMask suspended) noexcept {
  make_change();
  suspend(suspended);
  sim_.step(poses);
  if (recording) record([&] { recording->add(poses, sim_.state_hash()); });
  for (StatePublisher* publisher : publishers) publisher->publish(sim_);
}

bool Stepper::make_change() noexcept {
  Change* const change = changes.take();
  if (!change) return false;
  change->definition.apply_to(sim_);
  if (recording) record([&] { recording->add_change(std::move(change->settings)); });
  changes.give_back(change);
  return true;
}

void Stepper::suspend(HandMask hands) noexcept {
  for (std::size_t hand = 0; hand < holders_.size(); ++hand) {
    const std::uint32_t holder = holders_[hand];
    const bool now = hands >> hand & 1u, is_tool = holder < sim_.definition().tools.size();
    if (!is_tool || now == (suspended_ >> hand & 1u)) continue;
    sim_.suspend_contact(holder, now);
    if (recording) record([&] { recording->add_suspension(holder, now); });
  }
  suspended_ = hands;
}

template <class Add>
void Stepper::record(Add&& add) noexcept {
  try {
    add();
  } catch (...) {  // no memory for the recording, which is worth less than the hand
    recording = nullptr;
  }
}

}  // namespace crumble::haptics
