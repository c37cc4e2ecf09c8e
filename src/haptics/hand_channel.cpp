#include "haptics/hand_channel.hpp"

#include <algorithm>

namespace crumble::haptics {
namespace {

constexpr double kControllerShare = 0.9;  // of the damping limit

// Kc of the scene, where the hand feels g s^2 of it.
double scene_stiffness(const HandDef& def, double tick) {
  const double felt = def.workspace.force_gain * def.workspace.scale * def.workspace.scale;
  const double wanted =
      def.coupling.stiffness > 0 ? def.coupling.stiffness : safe_stiffness(def.device->info(), def.passivity, tick);
  return felt > 0 ? wanted / felt : kMostStiffness;
}

}  // namespace

HandChannel::HandChannel(const HandDef& def, double tick, double mean, double full_age)
    : def_(def),
      info_(def.device->info()),
      tick_(tick),
      mean_(mean),
      workspace_(def.workspace),
      samples_(def.safety, info_, tick),
      forces_(def.safety, info_, tick, full_age),
      coupling_(scene_stiffness(def, tick)),
      energy_(def.passivity),
      most_damping_(damping_limit(def.passivity, info_, tick)) {}

void HandChannel::sense(HandRequests& requests) noexcept {
  if (requests.reset.exchange(false) && state_ == HandState::faulted) wait_again();
  if (const Fault asked = requests.fault.exchange(Fault::none); asked != Fault::none) latch(asked);
  DeviceSample told;
  const ReadStatus status = def_.device->read(told);
  const Fault fault = samples_.take(status, told, counters_);
  finished_ = status == ReadStatus::finished;
  if (fault != Fault::none) {
    latch(fault);
    return;
  }
  if (!samples_.calibrated() && state_ != HandState::faulted) return release();
  if (samples_.good() > 0) energy_.moved(samples_.sample().pose.position);
  watch_clutch();
  follow_hand();
}

// While it is down the tool stays where it was, and the shift takes up what the hand does.
void HandChannel::watch_clutch() noexcept {
  const bool down = (samples_.sample().buttons & def_.clutch_buttons) != 0;
  if (down && state_ != HandState::faulted) {
    state_ = HandState::clutched;
    free_since_ = 0;
  } else if (!down && state_ == HandState::clutched) {
    state_ = HandState::waiting;
  }
}

void HandChannel::follow_hand() noexcept {
  scene_ = workspace_.to_scene(samples_.sample().pose);
  if (state_ == HandState::clutched) shift_ = tool_.position - scene_.position;
  scene_.position += shift_;
}

const Pose& HandChannel::move_tool(const Answer& answer) noexcept {
  tool_ = scene_;
  if (def_.coupling.enabled && touches(answer)) {
    tool_.position = coupling_.move(scene_.position, answer.wrench.force, answer.holding, mean_);
  } else {
    coupling_.place(scene_.position);
  }
  return tool_;
}

bool HandChannel::suspended() const noexcept {
  if (state_ == HandState::running || state_ == HandState::ramping) return false;
  return state_ != HandState::waiting || samples_.good() < def_.safety.good_samples;
}

bool HandChannel::touches(const Answer& answer) const noexcept {
  return answer.contacts > 0 && answer.order >= free_since_ && free_since_ > 0;
}

void HandChannel::let_in(const Answer& answer) noexcept {
  const bool outside = free_since_ > 0 && answer.order >= free_since_ && answer.engaged;
  if (state_ == HandState::waiting && outside) state_ = HandState::ramping;
  if (state_ == HandState::ramping && forces_.ramp() >= 1) state_ = HandState::running;
}

void HandChannel::feel(const Answer& answer, double age, Code body, std::uint64_t order) noexcept {
  if (suspended()) {
    free_since_ = 0;
  } else if (free_since_ == 0) {
    free_since_ = order;
  }
  if (body != Code{} && state_ != HandState::faulted) latch(Fault::body);
  if (age >= kStopAge && state_ != HandState::faulted) latch(Fault::stalled);
  let_in(answer);
  body_ = answer.wrench;
  contacts_ = touches(answer) ? answer.contacts : 0;
  if (state_ == HandState::faulted) take_force_away();  // in every tick: who knows what the device made of the last
  energy_.sent(state_ == HandState::faulted ? EnergyObserver::Sent{} : push(answer, age));
}

EnergyObserver::Sent HandChannel::push(const Answer& answer, double age) noexcept {
  const bool coupled = def_.coupling.enabled;
  Vec3 force = Vec3::Zero(), torque = Vec3::Zero();
  Mat3 stiffness = Mat3::Zero();
  if (contacts_ > 0) {
    force = workspace_.force_to_device(coupled ? coupling_.force_at(scene_.position) : answer.wrench.force);
    torque = workspace_.torque_to_device(answer.wrench.torque);
    stiffness = coupled ? Mat3(coupling_.stiffness() * Mat3::Identity()) : answer.stiffness;
    stiffness = workspace_.stiffness_to_device(stiffness);
  }
  const Vec3& velocity = samples_.velocity();
  const Mat3 brake = damping_for(stiffness, coupled ? 1 : mean_);
  const Vec3 damping = -rotate(brake, velocity);
  stiffness_ = size_of(stiffness), damping_ = size_of(brake);

  ForceGuard::Order order{.force = force + damping,
                          .torque = torque,
                          .age = age,
                          .position = samples_.sample().pose.position,
                          .heat = samples_.sample().motor_temperature,
                          .let_in = state_ == HandState::ramping || state_ == HandState::running};
  const double wanted = norm(order.force);
  if (const Fault fault = forces_.pass(order, counters_); fault != Fault::none)
    return latch(fault), EnergyObserver::Sent{};
  const double share = wanted > 0 ? norm(order.force) / wanted : 0;
  EnergyObserver::Sent sent{order.force, share * damping, Vec3::Zero()};
  if (def_.passivity.controller && contacts_ > 0) {
    sent.force += energy_.brake(velocity, tick_, kControllerShare * most_damping_);
    forces_.clamp(sent.force, counters_);
    sent.control = sent.force - order.force;
  }
  send(sent.force, order.torque);
  return sent;
}

// Symmetric as the stiffness; less what the device brakes by itself, and no more than it bears.
Mat3 HandChannel::damping_for(const Mat3& stiffness, double mean) noexcept {
  Mat3 damping = needed_damping(stiffness, tick_, mean, def_.passivity.delay);
  const double needed = size_of(damping);
  const double required = std::max(0.0, needed - info_.friction_damping);
  energy_.required(required);
  if (!(required > 0) || !def_.passivity.inject_damping) return Mat3::Zero();
  counters_.capped += required > most_damping_;
  return (std::min(required, most_damping_) / needed) * damping;
}

void HandChannel::latch(Fault fault) noexcept {
  if (state_ != HandState::faulted) {
    fault_ = fault;
    ++counters_.faults;
  }
  state_ = HandState::faulted;
  free_since_ = 0;
  take_force_away();
}

void HandChannel::wait_again() noexcept {
  state_ = HandState::waiting;
  fault_ = Fault::none;
  free_since_ = 0;
  samples_.forget();
  energy_.forget_position();
}

void HandChannel::release() noexcept {
  energy_.forget_position();
  if (state_ != HandState::faulted) wait_again();
  take_force_away();
}

void HandChannel::take_force_away() noexcept {
  forces_.drop();
  send(Vec3::Zero(), Vec3::Zero());
}

void HandChannel::send(const Vec3& force, const Vec3& torque) noexcept {
  force_ = force, torque_ = torque;
  forces_.sent(force, torque);
  def_.device->write(force, torque);
}

void HandChannel::report(HandStatus& out) const noexcept {
  out.state = state_, out.fault = fault_, out.finished = finished_;
  out.buttons = samples_.sample().buttons;
  out.contacts = contacts_;
  out.ramp = forces_.ramp();
  out.time = samples_.sample().time;
  out.device = samples_.sample().pose;
  out.velocity = samples_.velocity();
  out.tool = tool_;
  out.body = body_;
  out.force = force_, out.torque = torque_;
  out.stiffness = stiffness_, out.damping = damping_;
  out.energy = energy_.energy();
  out.counters = counters_;
}

}  // namespace crumble::haptics
