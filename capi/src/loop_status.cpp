// What any thread may ask of a loop, also while another is in it.
#include <string>

#include "arrays.hpp"
#include "crumble/base/memory.hpp"
#include "defs.hpp"
#include "field_names.hpp"
#include "loop.hpp"
#include "rigid.hpp"

namespace crumble::capi {
namespace {

static_assert(CRUMBLE_FAULT_NONE == static_cast<int>(Fault::none));
static_assert(CRUMBLE_FAULT_NOT_FINITE == static_cast<int>(Fault::not_finite));
static_assert(CRUMBLE_FAULT_BAD_POSE == static_cast<int>(Fault::bad_pose));
static_assert(CRUMBLE_FAULT_SPEED == static_cast<int>(Fault::speed));
static_assert(CRUMBLE_FAULT_STALLED == static_cast<int>(Fault::stalled));
static_assert(CRUMBLE_FAULT_SILENT == static_cast<int>(Fault::silent));
static_assert(CRUMBLE_FAULT_DEVICE_LOST == static_cast<int>(Fault::device_lost));
static_assert(CRUMBLE_FAULT_BODY == static_cast<int>(Fault::body));
static_assert(CRUMBLE_FAULT_HALTED == static_cast<int>(Fault::halted));
static_assert(CRUMBLE_FAULT_DRIVER == static_cast<int>(Fault::driver));
static_assert(CRUMBLE_HAND_WAITING == static_cast<int>(HandState::waiting));
static_assert(CRUMBLE_HAND_RAMPING == static_cast<int>(HandState::ramping));
static_assert(CRUMBLE_HAND_RUNNING == static_cast<int>(HandState::running));
static_assert(CRUMBLE_HAND_CLUTCHED == static_cast<int>(HandState::clutched));
static_assert(CRUMBLE_HAND_FAULTED == static_cast<int>(HandState::faulted));

crumble_loop_status describe(const HapticLoop& loop) {
  const LoopStatus status = loop.status();
  crumble_loop_status out{};
  out.running = loop.running();
  out.ticks = status.ticks;
  out.steps = status.steps;
  out.missed = status.missed;
  out.late_answers = status.late_answers;
  out.watchdog = status.watchdog;
  out.time = status.time;
  out.hand_count = status.hand_count;
  out.warning_count = static_cast<std::uint32_t>(loop.warnings().size());
  return out;
}

void add_energy(const HandEnergy& energy, crumble_hand_status& out) {
  out.absorbed = energy.absorbed;
  out.least_absorbed = energy.least;
  out.injected = energy.injected;
  out.controlled = energy.controlled;
  out.credit = energy.credit;
  out.required_damping = energy.required_damping;
}

void add_counters(const SafetyCounters& counters, crumble_hand_status& out) {
  out.held = counters.held;
  out.aged = counters.aged;
  out.outside = counters.outside;
  out.clamped = counters.clamped;
  out.heated = counters.heated;
  out.slewed = counters.slewed;
  out.capped = counters.capped;
  out.faults = counters.faults;
  out.unanswered = counters.unanswered;
}

crumble_hand_status describe(const HandStatus& hand) {
  crumble_hand_status out{};
  out.state = static_cast<std::uint32_t>(hand.state);
  out.fault = static_cast<std::uint32_t>(hand.fault);
  out.finished = hand.finished;
  out.buttons = hand.buttons;
  out.contacts = hand.contacts;
  out.ramp = hand.ramp;
  out.time = hand.time;
  out.device_pose = to_c(hand.device);
  copy_to(hand.velocity, out.velocity);
  out.tool_pose = to_c(hand.tool);
  out.body = to_c(hand.body);
  copy_to(hand.force, out.force);
  copy_to(hand.torque, out.torque);
  out.stiffness = hand.stiffness;
  out.damping = hand.damping;
  add_energy(hand.energy, out);
  add_counters(hand.counters, out);
  return out;
}

crumble_percentiles describe(const TimePercentiles& times) {
  return {times.count, times.p50, times.p99, times.p99_9, times.max};
}

crumble_loop_times describe(const LoopTimes& times) {
  return {0,
          0,
          describe(times.tick_wall),
          describe(times.tick_cpu),
          describe(times.lateness),
          describe(times.period),
          times.rate};
}

void require_hand(const Loop& loop, std::uint32_t hand) {
  if (hand < loop.hand_count()) return;
  throw Error(Code::out_of_range,
              "hand is " + std::to_string(hand) + ", the loop has " + std::to_string(loop.hand_count()));
}

}  // namespace
}  // namespace crumble::capi

using namespace crumble;
using namespace crumble::capi;

crumble_result crumble_loop_is_running(crumble_loop loop, uint32_t* running) {
  return look<Loop>(__func__, loop, [&](const Loop& l, const Call&) {
    require_pointer("running", running);
    *running = l.haptic().running();
    return CRUMBLE_OK;
  });
}

crumble_result crumble_loop_get_status(crumble_loop loop, crumble_loop_status* status) {
  return look<Loop>(__func__, loop, [&](const Loop& l, const Call&) {
    write_struct("status", status, describe(l.haptic()));
    return CRUMBLE_OK;
  });
}

crumble_result crumble_loop_get_hand(crumble_loop loop, uint32_t hand, crumble_hand_status* status) {
  return look<Loop>(__func__, loop, [&](const Loop& l, const Call&) {
    require_hand(l, hand);
    crumble_hand_status values = describe(l.haptic().status().hands[hand]);
    values.callback_error = l.device(hand).callback_error();
    write_struct("status", status, values);
    return CRUMBLE_OK;
  });
}

crumble_result crumble_loop_get_times(crumble_loop loop, crumble_loop_times* times) {
  return look<Loop>(__func__, loop, [&](const Loop& l, const Call&) {
    write_struct("times", times, describe(l.haptic().times()));
    return CRUMBLE_OK;
  });
}

crumble_result crumble_loop_get_warning(crumble_loop loop, uint32_t index, char* dst, uint64_t dst_bytes,
                                        uint64_t* needed) {
  return look<Loop>(__func__, loop, [&](const Loop& l, const Call& call) -> crumble_result {
    const Vector<std::string>& warnings = l.haptic().warnings();
    if (index >= warnings.size()) {
      return call.fail(CRUMBLE_E_OUT_OF_RANGE,
                       {"index is ", index, ", the loop has ", std::uint64_t{warnings.size()}, " warnings"});
    }
    return deliver(call, in_names_of_c(warnings[index]), dst, dst_bytes, needed);
  });
}

crumble_result crumble_loop_halt(crumble_loop loop) {
  return look<Loop>(__func__, loop, [](Loop& l, const Call&) {
    l.haptic().halt();
    return CRUMBLE_OK;
  });
}

crumble_result crumble_loop_reset_fault(crumble_loop loop, uint32_t hand) {
  return look<Loop>(__func__, loop, [&](Loop& l, const Call&) {
    require_hand(l, hand);
    l.haptic().reset_fault(hand);
    return CRUMBLE_OK;
  });
}

const char* crumble_fault_name(uint32_t fault) {
  return fault <= CRUMBLE_FAULT_DRIVER ? to_string(static_cast<Fault>(fault)) : "unknown";
}

const char* crumble_fault_reason(uint32_t fault) {
  return fault <= CRUMBLE_FAULT_DRIVER ? reason(static_cast<Fault>(fault)) : "no such fault";
}
