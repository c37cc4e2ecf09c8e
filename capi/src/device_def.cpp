#include "device_def.hpp"

#include <cmath>
#include <limits>

#include "defs.hpp"
#include "rigid.hpp"

namespace crumble::capi {
namespace {

static_assert(CRUMBLE_DEVICE_NULL == static_cast<int>(DeviceKind::null));
static_assert(CRUMBLE_DEVICE_PRESS == static_cast<int>(DeviceKind::press));
static_assert(CRUMBLE_DEVICE_REPLAY == static_cast<int>(DeviceKind::replay));
static_assert(CRUMBLE_DEVICE_PHANTOM == static_cast<int>(DeviceKind::phantom));
static_assert(CRUMBLE_DEVICE_CUSTOM == static_cast<int>(DeviceKind::custom));
static_assert(CRUMBLE_DEVICE_PATH == static_cast<int>(DeviceKind::path));
static_assert(CRUMBLE_DEVICE_HAND == static_cast<int>(DeviceKind::hand));
static_assert(CRUMBLE_DEVICE_POKE == static_cast<int>(DeviceKind::poke));
static_assert(CRUMBLE_DEVICE_TREMOR == static_cast<int>(DeviceKind::tremor));
static_assert(CRUMBLE_DEVICE_WANDER == static_cast<int>(DeviceKind::wander));
static_assert(CRUMBLE_DEVICE_INVERSE3 == static_cast<int>(DeviceKind::inverse3));
static_assert(CRUMBLE_CLOCK_STEP_LOCKED == static_cast<int>(ReplayClock::step_locked));
static_assert(CRUMBLE_CLOCK_REALTIME == static_cast<int>(ReplayClock::realtime));
static_assert(CRUMBLE_CLOCK_FAST == static_cast<int>(ReplayClock::fast));

void set_hardware_defaults(const DeviceDef& from, crumble_device_def& def) {
  def.phantom_rate = from.phantom.rate;
  copy_to(from.phantom.tip, def.phantom_tip);
  def.inverse3_timeout = from.inverse3.timeout;
  def.inverse3_port = from.inverse3.port;
}

void set_script_defaults(const DeviceDef& from, crumble_device_def& def) {
  def.poke_count = from.poke.count;
  def.poke_depth = from.poke.depth;
  def.poke_in = from.poke.in;
  def.poke_hold = from.poke.hold;
  def.poke_out = from.poke.out;
  def.poke_rest = from.poke.rest;
  def.tremor_amplitude = from.tremor.amplitude;
  def.tremor_low = from.tremor.low;
  def.tremor_high = from.tremor.high;
  copy_to(from.wander.low, def.wander_low);
  copy_to(from.wander.high, def.wander_high);
  def.wander_slowest = from.wander.slowest;
  def.wander_fastest = from.wander.fastest;
  def.wander_max_pause = from.wander.max_pause;
  def.wander_max_turn = from.wander.max_turn;
}

crumble_device_def default_device_def() {
  const DeviceDef from;
  crumble_device_def def{};
  def.struct_size = sizeof def;
  def.kind = CRUMBLE_DEVICE_NULL;
  def.tick = from.tick;
  def.start = to_c(Pose{});
  copy_to(from.press.direction, def.press_direction);
  def.press_speed = from.press.speed;
  def.press_depth = from.press.depth;
  def.press_hold = from.press.hold;
  def.replay_from = -std::numeric_limits<double>::infinity();
  def.replay_to = std::numeric_limits<double>::infinity();
  def.hand_mass = from.hand.mass;
  def.hand_stiffness = from.hand.stiffness;
  def.hand_damping = from.hand.damping;
  def.hand_friction = from.hand.friction;
  def.hand_encoder_step = from.hand.encoder_step;
  def.hand_device_mass = from.hand.device_mass;
  def.hand_max_force = from.hand.max_force;
  def.hand_max_stiffness = from.hand.max_stiffness;
  def.hand_max_damping = from.hand.max_damping;
  def.hand_delay = from.hand.delay;
  def.replay_clock = static_cast<std::uint32_t>(from.replay.clock);
  set_hardware_defaults(from, def);
  set_script_defaults(from, def);
  return def;
}

std::span<const crumble_motion_point> points_of(const crumble_device_def& def) {
  if (def.point_count > 0) require_pointer("points", def.points);
  return {def.points, def.point_count};
}

PathOptions to_path(const crumble_device_def& def) {
  PathOptions path{.start = to_pose(def.start), .points = {}};
  for (const crumble_motion_point& point : points_of(def)) {
    path.points.push_back({point.time, to_vector(point.move), to_vector(point.turn)});
  }
  return path;
}

HandOptions to_hand(const crumble_device_def& def) {
  HandOptions hand{.start = to_pose(def.start),
                   .points = {},
                   .mass = def.hand_mass,
                   .stiffness = def.hand_stiffness,
                   .damping = def.hand_damping,
                   .friction = def.hand_friction,
                   .encoder_step = def.hand_encoder_step,
                   .delay = def.hand_delay,
                   .device_mass = def.hand_device_mass,
                   .max_force = def.hand_max_force,
                   .max_stiffness = def.hand_max_stiffness,
                   .max_damping = def.hand_max_damping};
  for (const crumble_motion_point& point : points_of(def)) {
    hand.points.push_back({point.time, to_vector(point.move)});
  }
  return hand;
}

ReplayOptions to_replay(const crumble_device_def& def) {
  constexpr double kOpen = std::numeric_limits<double>::infinity();
  ReplayOptions replay{.end = def.replay_loop ? EndPolicy::loop : EndPolicy::hold,
                       .clock = static_cast<ReplayClock>(def.replay_clock)};
  if (def.replay_from != -kOpen) replay.from = def.replay_from;
  if (def.replay_to != kOpen) replay.to = def.replay_to;
  return replay;
}

std::string text_of(const char* text) {
  return text ? text : "";
}

PhantomOptions to_phantom(const crumble_device_def& def) {
  return {.library = text_of(def.phantom_library),
          .name = text_of(def.phantom_name),
          .rate = def.phantom_rate,
          .tip = to_vector(def.phantom_tip),
          .torque = def.phantom_torque != 0,
          .reset_encoders = def.phantom_reset_encoders != 0,
          .disable_on_close = def.phantom_keep_enabled == 0,
          .license_vendor = text_of(def.phantom_license_vendor),
          .license_application = text_of(def.phantom_license_application),
          .license_password = text_of(def.phantom_license_password)};
}

Inverse3Options to_inverse3(const crumble_device_def& def) {
  Inverse3Options options;
  if (def.inverse3_host) options.host = def.inverse3_host;
  options.port = static_cast<std::uint16_t>(def.inverse3_port);
  options.device_id = text_of(def.inverse3_device_id);
  options.timeout = def.inverse3_timeout;
  return options;
}

PokeOptions to_poke(const crumble_device_def& def) {
  return {.start = to_pose(def.start),
          .direction = to_vector(def.press_direction),
          .depth = def.poke_depth,
          .in = def.poke_in,
          .hold = def.poke_hold,
          .out = def.poke_out,
          .rest = def.poke_rest,
          .count = def.poke_count};
}

TremorOptions to_tremor(const crumble_device_def& def) {
  return {.start = to_pose(def.start),
          .amplitude = def.tremor_amplitude,
          .low = def.tremor_low,
          .high = def.tremor_high,
          .seed = def.seed,
          .seconds = def.seconds};
}

WanderOptions to_wander(const crumble_device_def& def) {
  return {.start = to_pose(def.start),
          .low = to_vector(def.wander_low),
          .high = to_vector(def.wander_high),
          .slowest = def.wander_slowest,
          .fastest = def.wander_fastest,
          .max_pause = def.wander_max_pause,
          .max_turn = def.wander_max_turn,
          .seed = def.seed,
          .seconds = def.seconds};
}

}  // namespace

crumble_device_def read_device_def(const crumble_device_def* def) {
  const crumble_device_def given = read_def("def", def, default_device_def());
  require_at_most("kind", given.kind, CRUMBLE_DEVICE_INVERSE3);
  require_at_most("replay_clock", given.replay_clock, CRUMBLE_CLOCK_FAST);
  require_at_most("record_capacity", given.record_capacity, kMaxTrajectoryRows);
  require_at_most("phantom_torque", given.phantom_torque, 1);
  require_at_most("phantom_reset_encoders", given.phantom_reset_encoders, 1);
  require_at_most("phantom_keep_enabled", given.phantom_keep_enabled, 1);
  require_at_most("inverse3_port", given.inverse3_port, 65535);
  require_at_most("reserved2", given.reserved2, 0);
  require_at_most("replay_loop", given.replay_loop, 1);
  require_at_most("reserved", given.reserved, 0);
  return given;
}

DeviceDef to_device_def(const crumble_device_def& def) {
  DeviceDef out{.kind = static_cast<DeviceKind>(def.kind), .tick = def.tick};
  switch (out.kind) {
    case DeviceKind::null:
      out.rest = to_pose(def.start);
      break;
    case DeviceKind::press:
      out.press = {to_pose(def.start), to_vector(def.press_direction), def.press_speed, def.press_depth,
                   def.press_hold};
      break;
    case DeviceKind::path:
      out.path = to_path(def);
      break;
    case DeviceKind::hand:
      out.hand = to_hand(def);
      break;
    case DeviceKind::replay:
      require_pointer("trajectory", def.trajectory);
      out.trajectory = def.trajectory;
      out.replay = to_replay(def);
      break;
    case DeviceKind::phantom:
      out.phantom = to_phantom(def);
      break;
    case DeviceKind::poke:
      out.poke = to_poke(def);
      break;
    case DeviceKind::tremor:
      out.tremor = to_tremor(def);
      break;
    case DeviceKind::wander:
      out.wander = to_wander(def);
      break;
    case DeviceKind::inverse3:
      out.inverse3 = to_inverse3(def);
      break;
    case DeviceKind::custom:
      break;
  }
  return out;
}

}  // namespace crumble::capi

using namespace crumble::capi;

crumble_result crumble_device_def_init(crumble_device_def* def, uint32_t struct_size) {
  return guard(__func__, [&](const Call&) {
    write_struct("def", def, struct_size, default_device_def());
    return CRUMBLE_OK;
  });
}
