#include "haptics/loop_def.hpp"

#include <algorithm>
#include <cmath>

#include "crumble/base/error.hpp"
#include "crumble/base/memory.hpp"
#include "crumble/base/text.hpp"

namespace crumble::haptics {
namespace {

constexpr double kLeastTick = 1e-4, kMostTick = 0.01;
constexpr std::uint32_t kMostBodyTicks = 100;

bool is_direct(const LoopDef& def) {
  return def.coupling == BodyCoupling::direct;
}

double body_step(const LoopDef& def) {
  return def.tick * def.body_ticks;
}

void check_times(const Simulation& sim, const LoopDef& def) {
  require_finite("tick", def.tick);
  require_in_range("tick", def.tick, kLeastTick, kMostTick);
  require_in_range("body_ticks", def.body_ticks, 1, is_direct(def) ? 1 : kMostBodyTicks);
  if (is_direct(def) && def.body_thread) {
    throw Error(Code::state, "body_thread needs coupling local_model or paper: a direct tick steps the body itself");
  }
  const StepSettings& step = sim.definition().step;
  const double tau = step.tau * step.iterations;
  if (std::abs(tau - body_step(def)) > 1e-9 * tau) {
    throw Error(Code::out_of_range, "tick * body_ticks is " + to_text(body_step(def)) +
                                        " s, but a step of the simulation advances " + to_text(tau) +
                                        " s: time would not be the hand's");
  }
}

void check_hands(const Simulation& sim, const LoopDef& def) {
  if (def.hands.empty()) throw Error(Code::empty, "hands is empty");
  if (def.hands.size() > kMaxHands) {
    throw Error(Code::too_large, "hands has " + std::to_string(def.hands.size()) + " entries, at most " +
                                     std::to_string(kMaxHands) + " are allowed");
  }
  for (std::size_t i = 0; i < def.hands.size(); ++i) {
    const HandDef& hand = def.hands[i];
    const std::string name = "hands[" + std::to_string(i) + "]";
    if (!hand.device) throw Error(Code::null, name + ".device is null");
    if (hand.holder >= sim.holder_count()) {
      throw Error(Code::out_of_range, name + ".holder is " + std::to_string(hand.holder) + ", the simulation has " +
                                          std::to_string(sim.holder_count()));
    }
    for (std::size_t j = 0; j < i; ++j) {
      if (def.hands[j].holder == hand.holder || def.hands[j].device == hand.device) {
        throw Error(Code::state, name + " has the holder or the device of hands[" + std::to_string(j) + "]");
      }
    }
    try {
      check(hand.coupling), check(hand.passivity), check(hand.safety);
      static_cast<void>(Workspace(hand.workspace));
    } catch (const Error& error) {
      throw Error(error.code(), name + "." + error.what());
    }
  }
}

// Time in the loop goes by the tick's length, whoever calls it.
void require_same_rate(const LoopDef& def, const DeviceInfo& info) {
  constexpr double kSame = 0.01;
  if (info.rate <= 0 || std::abs(info.rate * def.tick - 1) <= kSame) return;
  throw Error(Code::out_of_range, "tick is " + to_text(def.tick) + " s, but '" + info.name + "' ticks at " +
                                      to_text(info.rate) + " Hz, which makes " + to_text(1 / info.rate) + " s");
}

bool needs_polling(const Device& device, const Device* driving) {
  const DeviceInfo& info = device.info();
  if (!info.servo_driven || &device == driving) return false;
  return !driving || !info.servo_group || info.servo_group != driving->info().servo_group;
}

}  // namespace

void check(const Simulation& sim, const LoopDef& def) {
  check_times(sim, def);
  check_hands(sim, def);
}

double mean_of(const Simulation& sim, const LoopDef& def) {
  constexpr double kMean = 5;  // Eq (7)
  switch (def.coupling) {
    case BodyCoupling::direct:
      return sim.definition().step.mean_force ? kMean : 1;
    case BodyCoupling::local_model:
      return 1;
    case BodyCoupling::paper:
      return kMean * def.body_ticks;
  }
  return 1;
}

Device* driving_device(const LoopDef& def) {
  if (def.driver == LoopDriver::own_thread || def.driver == LoopDriver::host) return nullptr;
  for (const HandDef& hand : def.hands) {
    const DeviceInfo& info = hand.device->info();
    if (!info.servo_driven) continue;
    require_same_rate(def, info);
    return hand.device;
  }
  if (def.driver == LoopDriver::automatic) return nullptr;
  throw Error(Code::unsupported, "driver is device, but none of the devices has a thread of its own");
}

LoopDef with_polled(LoopDef def, const Device* driving, std::deque<PolledDevice>& polled) {
  for (HandDef& hand : def.hands) {
    if (!needs_polling(*hand.device, driving)) continue;
    hand.device = &polled.emplace_back(*hand.device);
    hand.passivity.delay = std::min(hand.passivity.delay + 1, kMostDelay);
  }
  return def;
}

Vector<std::string> find_warnings(const LoopDef& def) {
  Vector<std::string> warnings;
  for (std::size_t i = 0; i < def.hands.size(); ++i) {
    const HandDef& hand = def.hands[i];
    const DeviceInfo& info = hand.device->info();
    const std::string name = "hands[" + std::to_string(i) + "]: ";
    if (!hand.coupling.enabled) {
      warnings.push_back(name +
                         "without the virtual coupling the stiffness grows with the contact; see "
                         "HandEnergy::required_damping for what it takes");
      continue;
    }
    const double stiffness =
        hand.coupling.stiffness > 0 ? hand.coupling.stiffness : safe_stiffness(info, hand.passivity, def.tick);
    const double needed = stiffness * def.tick * (0.5 + hand.passivity.delay) - info.friction_damping;
    const double limit = hand.passivity.inject_damping ? damping_limit(hand.passivity, info, def.tick) : 0;
    if (needed > limit * (1 + 1e-9)) {
      warnings.push_back(name + "coupling.stiffness " + to_text(stiffness) + " N/m needs " + to_text(needed) +
                         " N s/m of damping, " + to_text(limit) + " are to be had: the loop may ring");
    }
  }
  return warnings;
}

}  // namespace crumble::haptics
