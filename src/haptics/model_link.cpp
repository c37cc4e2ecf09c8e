// The body steps beside the ticks: in a thread of its own, or here in every n-th tick, which then takes longer. What
// it found is handed over as a model of the contact. In here it is handed over where the next step begins, so that a
// step costs n ticks of time as it would in a thread, and everything repeats bit for bit.
//
//   ticks    |    |    |    |    |    |    |        n = 3
//   steps    [ step 1      ][ step 2      ][ ...
//   answers                 ^ 1            ^ 2
//
// A new model does not agree with the old one where the tool is by now. The difference goes to 0 over the n ticks till
// the next one, but where springs broke: there it is what the hand should feel.
#include <algorithm>
#include <array>

#include "crumble/base/latest_value.hpp"
#include "crumble/base/memory.hpp"
#include "haptics/body_link.hpp"
#include "haptics/periodic_thread.hpp"

namespace crumble::haptics {
namespace {

constexpr std::size_t kMean = 5;  // forces of Eq (7)

struct Order {
  Vector<Pose> poses;  // by holder
  HandMask suspended = 0;
  std::uint64_t order = 0;
};

struct HandModel {
  LocalModel model;
  Wrench mean;  // Eq (7)
  bool engaged = false;
};

struct Packet {
  Vector<HandModel> hands;
  Code status{};
  std::uint64_t order = 0, steps = 0;
  double time = 0;
};

Wrench operator-(const Wrench& a, const Wrench& b) {
  return {a.force - b.force, a.torque - b.torque};
}
Wrench operator+(const Wrench& a, const Wrench& b) {
  return {a.force + b.force, a.torque + b.torque};
}
Wrench operator*(double s, const Wrench& a) {
  return {s * a.force, s * a.torque};
}

class ModelLink final : public BodyLink {
 public:
  ModelLink(Stepper& stepper, const LoopDef& def)
      : stepper_(stepper),
        paper_(def.coupling == BodyCoupling::paper),
        threaded_(def.body_thread),
        ticks_(def.body_ticks),
        tick_(def.tick),
        history_(stepper.hand_count()),
        jumps_(stepper.hand_count()),
        tools_(stepper.hand_count()),
        orders_(Order{Vector<Pose>(stepper.sim().holder_count()), 0, 0}),
        answers_(Packet{Vector<HandModel>(stepper.hand_count()), Code{}, 0, 0, 0}) {}
  ~ModelLink() override { stop(); }

  Answer at(std::size_t hand, const Pose& tool) noexcept override {
    const Packet& packet = answers_.front();
    const HandModel& h = packet.hands[hand];
    tools_[hand] = tool;
    Wrench wrench = force_of(h, tool);
    const bool lets_go = wrench.force == Vec3::Zero() && wrench.torque == Vec3::Zero();
    if (!paper_ && !lets_go) wrench = smooth(hand);
    return {wrench, h.model.stiffness, h.model.holding, lets_go ? 0 : h.model.contacts, h.engaged, packet.order};
  }

  void advance(std::span<const Pose> poses, HandMask suspended, std::uint64_t order) noexcept override {
    Order& next = orders_.back();
    std::copy(poses.begin(), poses.end(), next.poses.begin());
    next.suspended = suspended, next.order = order;
    orders_.publish();
    if (!threaded_ && phase_ == 0) {
      if (pending_) answers_.publish();
      step();
      pending_ = true;
    }
    phase_ = (phase_ + 1) % ticks_;
    take_answer();
  }

  double age() const noexcept override { return static_cast<double>(since_) * tick_; }
  Code status() const noexcept override { return answers_.front().status; }
  std::uint64_t steps() const noexcept override { return answers_.front().steps; }
  double time() const noexcept override { return answers_.front().time; }

  void start() override {
    if (!threaded_) return;
    thread_.start(
        ticks_ * tick_, {},
        [](void* self) noexcept {
          static_cast<ModelLink*>(self)->step();
          static_cast<ModelLink*>(self)->answers_.publish();
          return true;
        },
        this);
  }
  void stop() noexcept override { thread_.stop(); }

 private:
  Wrench force_of(const HandModel& h, const Pose& tool) const noexcept {
    return paper_ ? h.mean : evaluate(h.model, tool);
  }

  // The stepping thread: fills answers_.back().
  void step() noexcept {
    orders_.fetch();
    const Order& order = orders_.front();
    stepper_.step(order.poses, order.suspended);
    const Simulation& sim = stepper_.sim();
    Packet& packet = answers_.back();
    packet.status = sim.info().status, packet.order = order.order;
    packet.steps = sim.info().step, packet.time = sim.info().time;
    for (std::size_t hand = 0; hand < packet.hands.size(); ++hand) {
      const std::uint32_t holder = stepper_.holder(hand);
      packet.hands[hand].model = sim.local_model(holder);
      packet.hands[hand].engaged = sim.engaged(holder);
      packet.hands[hand].mean = mean(hand, sim.wrench(holder), sim.info().step);
    }
  }

  // Eq (7), where the simulation does not do it itself.
  Wrench mean(std::size_t hand, const Wrench& now, std::uint64_t step) noexcept {
    if (!paper_ || stepper_.sim().definition().step.mean_force) return now;
    history_[hand][step % kMean] = now;
    Wrench sum;
    for (const Wrench& w : history_[hand]) sum = sum + w;
    return (1.0 / kMean) * sum;
  }

  // How much of the jump is left.
  double share() const noexcept { return since_ < ticks_ ? 1 - static_cast<double>(since_ + 1) / ticks_ : 0; }

  Wrench smooth(std::size_t hand) const noexcept {
    return share() * jumps_[hand] + force_of(answers_.front().hands[hand], tools_[hand]);
  }

  void take_answer() noexcept {
    ++since_;
    if (!answers_.has_new()) return;
    for (std::size_t hand = 0; hand < jumps_.size(); ++hand) jumps_[hand] = smooth(hand);
    answers_.fetch();
    since_ = 0;
    for (std::size_t hand = 0; hand < jumps_.size(); ++hand) {
      const HandModel& h = answers_.front().hands[hand];
      jumps_[hand] = h.model.fracture ? Wrench{} : jumps_[hand] - force_of(h, tools_[hand]);
    }
  }

  Stepper& stepper_;
  bool paper_, threaded_;
  std::uint32_t ticks_;
  double tick_;
  // the stepping thread's
  Vector<std::array<Wrench, kMean>> history_;
  // the servo's
  Vector<Wrench> jumps_;  // old answer - new one, where the tool was when the new one came
  Vector<Pose> tools_;    // where the hands asked last
  std::uint32_t phase_ = 0;
  std::uint64_t since_ = 0;  // ticks since the newest answer came
  bool pending_ = false;

  LatestValue<Order> orders_;
  LatestValue<Packet> answers_;
  PeriodicThread thread_;
};

}  // namespace

std::unique_ptr<BodyLink> make_model_link(Stepper& stepper, const LoopDef& def) {
  return std::make_unique<ModelLink>(stepper, def);
}

}  // namespace crumble::haptics
