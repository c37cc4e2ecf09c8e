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
  ReplayOptions replay{.end = def.replay_loop ? EndPolicy::loop : EndPolicy::hold};
  if (def.replay_from != -kOpen) replay.from = def.replay_from;
  if (def.replay_to != kOpen) replay.to = def.replay_to;
  return replay;
}

}  // namespace

crumble_device_def read_device_def(const crumble_device_def* def) {
  const crumble_device_def given = read_def("def", def, default_device_def());
  require_at_most("kind", given.kind, CRUMBLE_DEVICE_HAND);
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
    case DeviceKind::custom:
    case DeviceKind::poke:
    case DeviceKind::tremor:
    case DeviceKind::wander:
    case DeviceKind::inverse3:
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
