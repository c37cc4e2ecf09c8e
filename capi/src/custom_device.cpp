#include "custom_device.hpp"

#include <string>

#include "defs.hpp"
#include "rigid.hpp"

namespace crumble::capi {
namespace {

static_assert(CRUMBLE_SENSES_POSITION == quantity::kPosition && CRUMBLE_SENSES_ORIENTATION == quantity::kOrientation);
static_assert(CRUMBLE_SENSES_LINEAR_VELOCITY == quantity::kLinearVelocity);
static_assert(CRUMBLE_SENSES_ANGULAR_VELOCITY == quantity::kAngularVelocity);
static_assert(CRUMBLE_SENSES_BUTTONS == quantity::kButtons);
static_assert(CRUMBLE_SAMPLE_RESAMPLED == sample_flag::kResampled && CRUMBLE_SAMPLE_FINISHED == sample_flag::kFinished);
static_assert(CRUMBLE_SAMPLE_UNCALIBRATED == sample_flag::kUncalibrated && CRUMBLE_SAMPLE_HELD == sample_flag::kHeld);
static_assert(CRUMBLE_SAMPLE_FORCE_OFF == sample_flag::kForceOff);

constexpr std::uint32_t kSenses = CRUMBLE_SENSES_POSITION | CRUMBLE_SENSES_ORIENTATION |
                                  CRUMBLE_SENSES_LINEAR_VELOCITY | CRUMBLE_SENSES_ANGULAR_VELOCITY |
                                  CRUMBLE_SENSES_BUTTONS;

thread_local unsigned calls_within = 0;

void require_limits(const crumble_device_callbacks& c) {
  const struct {
    const char* name;
    double value;
  } limits[] = {{"rate", c.rate},
                {"max_force", c.max_force},
                {"continuous_force", c.continuous_force},
                {"max_torque", c.max_torque},
                {"max_stiffness", c.max_stiffness},
                {"max_damping", c.max_damping},
                {"max_speed", c.max_speed},
                {"mass", c.mass},
                {"friction_damping", c.friction_damping},
                {"position_step", c.position_step}};
  for (const auto& [name, value] : limits) {
    const std::string field = std::string("callbacks.") + name;
    require_finite(field, value);
    if (value < 0) require_positive(field, value);
  }
  for (int axis = 0; axis < 3; ++axis) {
    const std::string low = std::string("callbacks.workspace_low.") + "xyz"[axis];
    const std::string high = std::string("callbacks.workspace_high.") + "xyz"[axis];
    require_finite(low, c.workspace_low[axis]);
    require_finite(high, c.workspace_high[axis]);
    if (c.workspace_low[axis] > c.workspace_high[axis]) throw Error(Code::out_of_range, low + " is above " + high);
  }
}

template <class Callback>
void require_callback(const char* name, Callback callback) {
  if (!callback) throw Error(Code::null, std::string(name) + " must not be NULL");
}

void check(const crumble_device_callbacks& c) {
  require_callback("callbacks.read", c.read);
  require_callback("callbacks.write", c.write);
  require_at_most("callbacks.flags", c.flags, CRUMBLE_DEVICE_STEP_LOCKED | CRUMBLE_DEVICE_SERVO_DRIVEN);
  require_at_most("callbacks.measured", c.measured, kSenses);
  require_at_most("callbacks.reserved", c.reserved, 0);
  if (c.flags & CRUMBLE_DEVICE_SERVO_DRIVEN) {
    require_callback("callbacks.start", c.start);
    require_callback("callbacks.stop", c.stop);
  }
  require_limits(c);
}

DeviceInfo describe(const crumble_device_callbacks& c) {
  return {.name = c.name ? c.name : "custom device",
          .kind = DeviceKind::custom,
          .max_force = c.max_force,
          .measured = c.measured,
          .rate = c.rate,
          .step_locked = (c.flags & CRUMBLE_DEVICE_STEP_LOCKED) != 0,
          .servo_driven = (c.flags & CRUMBLE_DEVICE_SERVO_DRIVEN) != 0,
          .continuous_force = c.continuous_force,
          .max_torque = c.max_torque,
          .max_stiffness = c.max_stiffness,
          .max_damping = c.max_damping,
          .max_speed = c.max_speed,
          .mass = c.mass,
          .friction_damping = c.friction_damping,
          .position_step = c.position_step,
          .workspace_low = to_vector(c.workspace_low),
          .workspace_high = to_vector(c.workspace_high)};
}

DeviceSample from_c(const crumble_device_sample& told) {
  DeviceSample sample{
      .time = told.time,
      .pose = to_pose(told.pose),
      .linear_velocity = to_vector(told.linear_velocity),
      .angular_velocity = to_vector(told.angular_velocity),
      .buttons = told.buttons,
      .flags = told.flags & (CRUMBLE_SAMPLE_RESAMPLED | CRUMBLE_SAMPLE_UNCALIBRATED | CRUMBLE_SAMPLE_FORCE_OFF),
      .sequence = told.sequence,
      .motor_temperature = told.motor_temperature};
  if (told.status == CRUMBLE_READ_FINISHED) sample.flags |= sample_flag::kFinished;
  return sample;
}

}  // namespace

bool in_callback() noexcept {
  return calls_within > 0;
}

crumble_device_callbacks default_callbacks() {
  crumble_device_callbacks callbacks{};
  callbacks.struct_size = sizeof callbacks;
  callbacks.measured = CRUMBLE_SENSES_POSITION;
  return callbacks;
}

std::unique_ptr<CustomDevice> open_custom(const crumble_device_callbacks* callbacks) {
  const crumble_device_callbacks given = read_def("callbacks", callbacks, default_callbacks());
  check(given);
  return std::make_unique<CustomDevice>(given);
}

CustomDevice::CustomDevice(const crumble_device_callbacks& callbacks)
    : callbacks_(callbacks), info_(describe(callbacks)) {}

// A callback in C++ may throw, which is no better than an error.
template <class Callback, class... Arguments>
bool CustomDevice::call(const char* text, Callback callback, Arguments... arguments) noexcept {
  crumble_result result = CRUMBLE_E_INTERNAL;
  ++calls_within;
  try {
    result = callback(arguments..., callbacks_.user);
  } catch (...) {
  }
  --calls_within;
  if (result != CRUMBLE_OK) lose(result, text);
  return result == CRUMBLE_OK;
}

void CustomDevice::lose(crumble_result result, const char* text) noexcept {
  crumble_result none = CRUMBLE_OK;
  if (error_.compare_exchange_strong(none, result)) error_text_ = text;
}

ReadStatus CustomDevice::read(DeviceSample& sample) noexcept {
  if (error() != CRUMBLE_OK) return ReadStatus::lost;
  crumble_device_sample told{};
  told.struct_size = sizeof told;
  told.sequence = count_;
  told.pose.orientation[0] = 1;
  if (!call("its callback `read` failed", callbacks_.read, &told)) return ReadStatus::lost;
  if (told.status == CRUMBLE_READ_NO_NEW_SAMPLE) return ReadStatus::no_new_sample;
  if (told.status > CRUMBLE_READ_FINISHED) {
    lose(CRUMBLE_E_OUT_OF_RANGE, "its callback `read` gave a status that there is not");
    return ReadStatus::lost;
  }
  sample = from_c(told);
  ++count_;
  return told.status == CRUMBLE_READ_FINISHED ? ReadStatus::finished : ReadStatus::ok;
}

void CustomDevice::write(const Vec3& force, const Vec3& torque) noexcept {
  double f[3]{}, t[3]{};
  if (error() == CRUMBLE_OK) copy_to(force, f), copy_to(torque, t);
  call("its callback `write` failed", callbacks_.write, &f[0], &t[0]);
}

std::uint32_t CustomDevice::tick(void* self) noexcept {
  const ServoTick& servo = static_cast<CustomDevice*>(self)->servo_;
  return servo.call(servo.context);
}

void CustomDevice::start_servo(const ServoTick& tick_of_loop) {
  if (!info_.servo_driven) return Device::start_servo(tick_of_loop);
  servo_ = tick_of_loop;
  driving_ = error() == CRUMBLE_OK &&
             call("its callback `start` failed", callbacks_.start, crumble_device_tick{tick}, static_cast<void*>(this));
  if (driving_) return;
  throw Error(Code::device_lost,
              "device '" + info_.name + "' is lost: " + error_text() + ", answer " + std::to_string(error()));
}

void CustomDevice::stop_servo() noexcept {
  if (driving_) call("its callback `stop` failed", callbacks_.stop);
  driving_ = false;
}

}  // namespace crumble::capi

using namespace crumble::capi;

crumble_result crumble_device_callbacks_init(crumble_device_callbacks* callbacks, uint32_t struct_size) {
  return guard(__func__, [&](const Call&) {
    write_struct("callbacks", callbacks, struct_size, default_callbacks());
    return CRUMBLE_OK;
  });
}
