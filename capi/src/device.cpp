// The crumble_device_ functions.
#include "device.hpp"

#include <algorithm>
#include <string>

#include "crumble/device/attached.hpp"
#include "crumble/device/hapi_log.hpp"
#include "defs.hpp"
#include "device_def.hpp"
#include "log.hpp"
#include "objects.hpp"
#include "rigid.hpp"

namespace crumble::capi {

constinit HandleTable OpenDevice::table{4};

namespace {

static_assert(CRUMBLE_READ_OK == static_cast<int>(ReadStatus::ok));
static_assert(CRUMBLE_READ_NO_NEW_SAMPLE == static_cast<int>(ReadStatus::no_new_sample));
static_assert(CRUMBLE_READ_FINISHED == static_cast<int>(ReadStatus::finished));

// As much of the text as fits, without half a character at the end.
template <std::size_t N>
void copy_text(std::string_view text, char (&out)[N]) {
  std::size_t length = std::min(text.size(), N - 1);
  if (length < text.size()) {
    while (length > 0 && (static_cast<unsigned char>(text[length]) & 0xc0u) == 0x80u) --length;
  }
  std::copy_n(text.data(), length, out);
  out[length] = '\0';
}

crumble_device_info describe(const OpenDevice& open) {
  const DeviceInfo& info = open.device->info();
  crumble_device_info out{};
  out.kind = static_cast<std::uint32_t>(info.kind);
  out.measured = info.measured;
  if (info.step_locked) out.flags |= CRUMBLE_DEVICE_STEP_LOCKED;
  if (info.servo_driven) out.flags |= CRUMBLE_DEVICE_SERVO_DRIVEN;
  copy_text(info.name, out.name);
  out.rate = info.rate;
  out.max_force = info.max_force;
  out.continuous_force = info.continuous_force;
  out.max_torque = info.max_torque;
  out.max_stiffness = info.max_stiffness;
  out.max_damping = info.max_damping;
  out.max_speed = info.max_speed;
  out.mass = info.mass;
  out.friction_damping = info.friction_damping;
  out.position_step = info.position_step;
  copy_to(info.workspace_low, out.workspace_low);
  copy_to(info.workspace_high, out.workspace_high);
  out.callback_error = open.callback_error();
  copy_text(info.driver, out.driver);
  copy_text(info.serial, out.serial);
  return out;
}

crumble_device_sample describe(const DeviceSample& sample, ReadStatus status) {
  crumble_device_sample out{};
  out.status = static_cast<std::uint32_t>(status);
  out.buttons = sample.buttons;
  out.flags = sample.flags;
  out.sequence = sample.sequence;
  out.time = sample.time;
  out.pose = to_c(sample.pose);
  copy_to(sample.linear_velocity, out.linear_velocity);
  copy_to(sample.angular_velocity, out.angular_velocity);
  out.motor_temperature = sample.motor_temperature;
  return out;
}

crumble_result fail_lost(const OpenDevice& open, const Call& call) noexcept {
  const std::string_view text = open.device->error_text();
  if (text.empty()) return call.fail(CRUMBLE_E_DEVICE_LOST, {"device is lost"});
  return call.fail(CRUMBLE_E_DEVICE_LOST, {"device is lost: ", text});
}

Vec3 read_finite(const char* name, const double* v) {
  for (int axis = 0; axis < 3; ++axis) require_finite(name + std::string(".") + "xyz"[axis], v[axis]);
  return {v[0], v[1], v[2]};
}

void record(OpenDevice& open, std::uint32_t capacity) {
  if (capacity == 0) return;
  auto recorder = std::make_unique<Recorder>(std::move(open.device), capacity);
  open.recorder = recorder.get();
  open.device = std::move(recorder);
}

crumble_attached_device describe(const AttachedDevice& found) {
  crumble_attached_device out{};
  out.kind = static_cast<std::uint32_t>(found.kind);
  out.can_be_opened = found.can_be_opened;
  copy_text(found.name, out.name);
  copy_text(found.note, out.note);
  return out;
}

std::unique_ptr<OpenDevice> open(const crumble_device_def& def) {
  auto made = std::make_unique<OpenDevice>();
  if (def.kind == CRUMBLE_DEVICE_CUSTOM) {
    auto custom = open_custom(def.callbacks);
    made->custom = custom.get();
    made->device = std::move(custom);
  } else {
    made->device = open_device(to_device_def(def));
  }
  record(*made, def.record_capacity);
  return made;
}

}  // namespace
}  // namespace crumble::capi

using namespace crumble;
using namespace crumble::capi;

const char* crumble_device_kind_name(uint32_t index) {
  const char* name = nullptr;
  guard(__func__, [&](const Call&) {
    const auto kinds = available_devices();
    if (index <= kinds.size()) name = to_string(index < kinds.size() ? kinds[index] : DeviceKind::custom);
    return CRUMBLE_OK;
  });
  return name;
}

crumble_result crumble_device_kind(const char* name, uint32_t* kind) {
  return guard(__func__, [&](const Call&) {
    require_pointer("name", name);
    require_pointer("kind", kind);
    *kind = static_cast<uint32_t>(device_kind(name));
    return CRUMBLE_OK;
  });
}

crumble_result crumble_device_open(const crumble_device_def* def, crumble_device* device) {
  return guard(__func__, [&](const Call&) {
    require_pointer("device", device);
    auto opened = open(read_device_def(def));
    const DeviceInfo& info = opened->device->info();
    log(CRUMBLE_LOG_NOTE, "opened " + info.name + (info.driver.empty() ? "" : " through " + info.driver));
    publish(std::move(opened), device);
    return CRUMBLE_OK;
  });
}

crumble_result crumble_device_destroy(crumble_device device) {
  return destroy<OpenDevice>(__func__, device);
}

crumble_result crumble_device_get_info(crumble_device device, crumble_device_info* info) {
  return with<OpenDevice>(__func__, device, [&](const OpenDevice& d, const Call&) {
    write_struct("info", info, describe(d));
    return CRUMBLE_OK;
  });
}

crumble_result crumble_device_read(crumble_device device, crumble_device_sample* sample) {
  return with<OpenDevice>(__func__, device, [&](OpenDevice& d, const Call& call) -> crumble_result {
    require_pointer("sample", sample);
    check_struct_size("sample", sample->struct_size);
    DeviceSample told;
    const ReadStatus status = d.for_host().read(told);
    if (status == ReadStatus::lost) return fail_lost(d, call);
    if (status == ReadStatus::no_new_sample) {
      sample->status = CRUMBLE_READ_NO_NEW_SAMPLE;
    } else {
      write_struct("sample", sample, describe(told, status));
    }
    return CRUMBLE_OK;
  });
}

crumble_result crumble_device_write(crumble_device device, const double* force, const double* torque) {
  return with<OpenDevice>(__func__, device, [&](OpenDevice& d, const Call& call) -> crumble_result {
    require_pointer("force", force);
    const Vec3 f = read_finite("force", force);
    const Vec3 t = torque ? read_finite("torque", torque) : Vec3::Zero();
    d.for_host().write(f, t);
    return d.callback_error() == CRUMBLE_OK ? CRUMBLE_OK : fail_lost(d, call);
  });
}

crumble_result crumble_device_get_text(crumble_device device, const char** text) {
  return look<OpenDevice>(__func__, device, [&](const OpenDevice& d, const Call&) {
    require_pointer("text", text);
    *text = d.device->error_text();
    return CRUMBLE_OK;
  });
}

crumble_result crumble_device_save_trajectory(crumble_device device, const char* path) {
  return with<OpenDevice>(__func__, device, [&](const OpenDevice& d, const Call& call) -> crumble_result {
    const std::filesystem::path to = path_of(path);
    if (!d.recorder) return call.fail(CRUMBLE_E_STATE, {"nothing is recorded: record_capacity was 0"});
    write_trajectory(to, d.recorder->trajectory());
    return CRUMBLE_OK;
  });
}

crumble_result crumble_trajectory_import_hapi(const char* log, double length_unit, const char* trajectory) {
  return guard(__func__, [&](const Call&) {
    require_pointer("log", log);
    require_pointer("trajectory", trajectory);
    write_trajectory(trajectory, read_hapi_log(log, {.length_unit = length_unit}));
    return CRUMBLE_OK;
  });
}

crumble_result crumble_device_find_attached(const char* library, crumble_attached_device* devices, uint32_t capacity,
                                            uint32_t* count) {
  return guard(__func__, [&](const Call& call) -> crumble_result {
    require_pointer("count", count);
    if (capacity > 0) require_pointer("devices", devices);
    const auto found = attached_devices({.library = library ? library : ""});
    const auto fit = std::min<std::size_t>(found.size(), capacity);
    for (std::size_t i = 0; i < fit; ++i) devices[i] = describe(found[i]);
    *count = static_cast<uint32_t>(found.size());
    if (fit == found.size()) return CRUMBLE_OK;
    return call.fail(CRUMBLE_E_BUFFER_TOO_SMALL, {"capacity is smaller than the number of devices, see count"});
  });
}
