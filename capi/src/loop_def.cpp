#include "loop_def.hpp"

#include <string>

#include "crumble/base/memory.hpp"
#include "defs.hpp"
#include "rigid.hpp"

namespace crumble::capi {
namespace {

static_assert(CRUMBLE_COUPLING_DIRECT == static_cast<int>(BodyCoupling::direct));
static_assert(CRUMBLE_COUPLING_LOCAL_MODEL == static_cast<int>(BodyCoupling::local_model));
static_assert(CRUMBLE_COUPLING_PAPER == static_cast<int>(BodyCoupling::paper));
static_assert(CRUMBLE_DRIVER_OWN_THREAD == static_cast<int>(LoopDriver::own_thread));
static_assert(CRUMBLE_DRIVER_DEVICE == static_cast<int>(LoopDriver::device));
static_assert(CRUMBLE_DRIVER_HOST == static_cast<int>(LoopDriver::host));
static_assert(CRUMBLE_DRIVER_AUTOMATIC == static_cast<int>(LoopDriver::automatic));
static_assert(CRUMBLE_MOST_HANDS == kMaxHands);

crumble_loop_def default_loop_def() {
  const LoopDef from;
  crumble_loop_def def{};
  def.struct_size = sizeof def;
  def.coupling = static_cast<std::uint32_t>(from.coupling);
  def.tick = from.tick;
  def.body_ticks = from.body_ticks;
  def.body_thread = from.body_thread;
  def.driver = static_cast<std::uint32_t>(from.driver);
  def.watchdog = from.watchdog;
  def.priority = from.thread.priority;
  def.processor = from.thread.processor;
  def.lock_memory = from.thread.lock_memory;
  return def;
}

crumble_hand_def default_hand_def() {
  const HandDef from;
  crumble_hand_def def{};
  def.struct_size = sizeof def;
  def.workspace = to_c(from.workspace.pose);
  def.workspace_mount[0] = 1;
  def.workspace_scale = from.workspace.scale;
  def.force_gain = from.workspace.force_gain;
  def.coupling = from.coupling.enabled;
  def.coupling_stiffness = from.coupling.stiffness;
  def.inject_damping = from.passivity.inject_damping;
  def.controller = from.passivity.controller;
  def.delay = from.passivity.delay;
  def.max_damping = from.passivity.max_damping;
  def.energy_credit = from.passivity.energy_credit;
  def.max_force = from.safety.max_force;
  def.max_torque = from.safety.max_torque;
  def.max_speed = from.safety.max_speed;
  def.max_jump = from.safety.max_jump;
  def.max_slew = from.safety.max_slew;
  def.ramp_time = from.safety.ramp_time;
  def.workspace_margin = from.safety.workspace_margin;
  def.good_samples = from.safety.good_samples;
  return def;
}

void require_between(const char* field, std::int32_t value, std::int32_t least, std::int32_t greatest) {
  if (value >= least && value <= greatest) return;
  throw Error(Code::out_of_range, std::string(field) + " must lie in [" + std::to_string(least) + ", " +
                                      std::to_string(greatest) + "], is " + std::to_string(value));
}

// Element `index` of an array whose elements are as large as their program's header says.
template <class Def>
Def* element(Def* array, std::uint32_t index) {
  using Byte = std::conditional_t<std::is_const_v<Def>, const char, char>;
  return reinterpret_cast<Def*>(reinterpret_cast<Byte*>(array) + std::size_t{array->struct_size} * index);
}

}  // namespace

LoopDef read_loop_def(const crumble_loop_def* def) {
  if (!def) return {};
  const crumble_loop_def given = read_def("def", def, default_loop_def());
  require_at_most("coupling", given.coupling, CRUMBLE_COUPLING_PAPER);
  require_at_most("body_thread", given.body_thread, 1);
  require_at_most("driver", given.driver, CRUMBLE_DRIVER_AUTOMATIC);
  require_at_most("watchdog", given.watchdog, 1);
  require_between("priority", given.priority, 0, 99);
  require_between("processor", given.processor, -1, 1023);
  require_at_most("lock_memory", given.lock_memory, 1);
  require_at_most("reserved", given.reserved, 0);
  LoopDef out;
  out.tick = given.tick;
  out.coupling = static_cast<BodyCoupling>(given.coupling);
  out.body_ticks = given.body_ticks;
  out.body_thread = given.body_thread != 0;
  out.driver = static_cast<LoopDriver>(given.driver);
  out.watchdog = given.watchdog != 0;
  out.thread = {given.priority, given.lock_memory != 0, given.processor};
  return out;
}

Vector<crumble_hand_def> read_hands(const crumble_hand_def* hands, std::uint32_t count) {
  if (count > CRUMBLE_MOST_HANDS) {
    throw Error(Code::too_large,
                "hand_count must be at most " + std::to_string(CRUMBLE_MOST_HANDS) + ", is " + std::to_string(count));
  }
  if (count > 0) require_pointer("hands", hands);
  Vector<crumble_hand_def> out;
  for (std::uint32_t i = 0; i < count; ++i) {
    const std::string name = "hands[" + std::to_string(i) + "]";
    if (i > 0) check_struct_size("hands[0]", hands->struct_size);
    const crumble_hand_def* const hand = element(hands, i);
    if (hand->struct_size != hands->struct_size && hand->struct_size != 0) {
      throw Error(Code::version, name + ".struct_size is " + std::to_string(hand->struct_size) + ", that of hands[0] " +
                                     std::to_string(hands->struct_size));
    }
    out.push_back(read_def(name.c_str(), hand, default_hand_def()));
    require_at_most((name + ".coupling").c_str(), out[i].coupling, 1);
    require_at_most((name + ".inject_damping").c_str(), out[i].inject_damping, 1);
    require_at_most((name + ".controller").c_str(), out[i].controller, 1);
    require_at_most((name + ".reserved").c_str(), out[i].reserved, 0);
  }
  return out;
}

HandDef to_hand_def(const crumble_hand_def& def) {
  HandDef out;
  out.holder = def.tool;
  const double* const q = def.workspace_mount;
  out.workspace = {to_pose(def.workspace), def.workspace_scale, def.force_gain, Quat(q[0], q[1], q[2], q[3])};
  out.clutch_buttons = def.clutch_buttons;
  out.coupling = {def.coupling != 0, def.coupling_stiffness};
  out.passivity = {def.inject_damping != 0, def.delay, def.max_damping, def.controller != 0, def.energy_credit};
  out.safety = {def.max_force, def.max_torque, def.max_speed,    def.max_jump,
                def.max_slew,  def.ramp_time,  def.good_samples, def.workspace_margin};
  return out;
}

namespace {

void apply_preset(crumble_loop_def* def, crumble_hand_def* hands, std::uint32_t count) {
  crumble_loop_def loop = read_def("def", def, default_loop_def());
  const Vector<crumble_hand_def> given = read_hands(hands, count);
  LoopDef paper;
  paper.hands.resize(1);
  apply_paper_preset(paper);
  loop.coupling = static_cast<std::uint32_t>(paper.coupling);
  write_struct("def", def, def->struct_size, loop);
  const HandDef& like = paper.hands.front();
  for (std::uint32_t i = 0; i < count; ++i) {
    crumble_hand_def hand = given[i];
    hand.coupling = like.coupling.enabled;
    hand.inject_damping = like.passivity.inject_damping;
    hand.controller = like.passivity.controller;
    crumble_hand_def* const to = element(hands, i);
    write_struct("hands", to, to->struct_size, hand);
  }
}

}  // namespace
}  // namespace crumble::capi

using namespace crumble::capi;

crumble_result crumble_loop_def_init(crumble_loop_def* def, uint32_t struct_size) {
  return guard(__func__, [&](const Call&) {
    write_struct("def", def, struct_size, default_loop_def());
    return CRUMBLE_OK;
  });
}

crumble_result crumble_hand_def_init(crumble_hand_def* def, uint32_t struct_size) {
  return guard(__func__, [&](const Call&) {
    write_struct("def", def, struct_size, default_hand_def());
    return CRUMBLE_OK;
  });
}

crumble_result crumble_loop_apply_paper_preset(crumble_loop_def* def, crumble_hand_def* hands, uint32_t hand_count) {
  return guard(__func__, [&](const Call&) {
    apply_preset(def, hands, hand_count);
    return CRUMBLE_OK;
  });
}
