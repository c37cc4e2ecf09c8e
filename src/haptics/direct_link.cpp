#include "crumble/base/memory.hpp"
#include "haptics/body_link.hpp"

namespace crumble::haptics {
namespace {

class DirectLink final : public BodyLink {
 public:
  explicit DirectLink(Stepper& stepper) : stepper_(stepper), answers_(stepper.hand_count()) {}

  Answer at(std::size_t hand, const Pose&) noexcept override { return answers_[hand]; }

  void advance(std::span<const Pose> poses, HandMask suspended, std::uint64_t order) noexcept override {
    stepper_.step(poses, suspended);
    const Simulation& sim = stepper_.sim();
    for (std::size_t hand = 0; hand < answers_.size(); ++hand) {
      const std::uint32_t holder = stepper_.holder(hand);
      const LocalModel model = sim.local_model(holder);
      answers_[hand] = {sim.wrench(holder), model.stiffness, model.holding, model.contacts, sim.engaged(holder), order};
    }
  }
  double age() const noexcept override { return 0; }
  Code status() const noexcept override { return stepper_.sim().info().status; }
  std::uint64_t steps() const noexcept override { return stepper_.sim().info().step; }
  double time() const noexcept override { return stepper_.sim().info().time; }

 private:
  Stepper& stepper_;
  Vector<Answer> answers_;
};

}  // namespace

std::unique_ptr<BodyLink> make_direct_link(Stepper& stepper) {
  return std::make_unique<DirectLink>(stepper);
}

}  // namespace crumble::haptics
