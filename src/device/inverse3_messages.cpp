#include "device/inverse3_messages.hpp"

#include <cmath>
#include <nlohmann/json.hpp>

#include "crumble/base/memory.hpp"

namespace crumble::device {
namespace {

using Json = nlohmann::json;

// Thrown and caught in this file.
struct Malformed {};

Json parse(std::string_view text) {
  Json message = Json::parse(text, nullptr, false);
  if (!message.is_object()) throw Malformed{};
  return message;
}

// The member `name` of `object`; null when it is not there. A member that is there is of the type that `is` asks for.
const Json* member(const Json& object, const char* name, bool (Json::*is)() const noexcept) {
  if (!object.is_object()) throw Malformed{};
  const auto found = object.find(name);
  if (found == object.end()) return nullptr;
  if (!((*found).*is)()) throw Malformed{};
  return &*found;
}

double number(const Json& object, const char* name) {
  const Json* found = member(object, name, &Json::is_number);
  const double value = found ? found->get<double>() : std::nan("");
  if (!std::isfinite(value)) throw Malformed{};
  return value;
}

Vec3 from_haply(const Vec3& v) {
  return {v.x(), v.z(), -v.y()};
}

Vec3 to_haply(const Vec3& v) {
  return {v.x(), -v.z(), v.y()};
}

Vec3 vector(const Json& object) {
  return from_haply({number(object, "x"), number(object, "y"), number(object, "z")});
}

const Json* state_of(const Json& device) {
  return member(device, "state", &Json::is_object);
}

void read_device(const Json& device, Inverse3State& state) {
  const Json* told = state_of(device);
  if (!told) return;
  if (const Json* position = member(*told, "cursor_position", &Json::is_object)) {
    state.position = vector(*position);
    state.measured |= quantity::kPosition;
  }
  if (const Json* velocity = member(*told, "cursor_velocity", &Json::is_object)) {
    state.velocity = vector(*velocity);
    state.measured |= quantity::kLinearVelocity;
  }
}

void read_grip(const Json& grip, Inverse3State& state) {
  const Json* told = state_of(grip);
  if (!told) return;
  if (const Json* q = member(*told, "orientation", &Json::is_object)) {
    const Vec3 axis = vector(*q);
    const double w = number(*q, "w");
    const double length = std::sqrt(squared_norm(axis) + w * w);
    // Far from unit length it is no orientation: what a grip tells that is asleep, say.
    if (std::abs(length - 1) <= 0.1) {
      state.orientation = Quat(w / length, axis.x() / length, axis.y() / length, axis.z() / length);
      state.measured |= quantity::kOrientation;
    }
  }
  if (const Json* buttons = member(*told, "buttons", &Json::is_object)) {
    std::uint32_t bit = 1;
    for (const char* name : {"a", "b", "c"}) {
      const Json* pressed = member(*buttons, name, &Json::is_boolean);
      if (pressed && pressed->get<bool>()) state.buttons |= bit;
      bit <<= 1;
    }
    state.measured |= quantity::kButtons;
  }
}

const std::string& id_of(const Json& device) {
  const Json* id = member(device, "device_id", &Json::is_string);
  if (!id) throw Malformed{};
  return id->get_ref<const std::string&>();
}

Inverse3State state_in(const Json& message, std::string_view device_id) {
  Inverse3State state;
  if (const Json* devices = member(message, "inverse3", &Json::is_array)) {
    for (const Json& device : *devices) {
      if (id_of(device) != device_id) continue;
      read_device(device, state);
      break;
    }
  }
  const Json* grips = member(message, "wireless_verse_grip", &Json::is_array);
  if (grips && !grips->empty()) read_grip(grips->front(), state);
  return state;
}

}  // namespace

MessageKind read_state(std::string_view text, std::string_view device_id, Inverse3State& state) noexcept {
  try {
    const Inverse3State told = state_in(parse(text), device_id);
    if (!(told.measured & quantity::kPosition)) return MessageKind::other;
    state = told;
    return MessageKind::state;
  } catch (...) {  // Malformed, or no memory left to find out
    return MessageKind::malformed;
  }
}

std::optional<Vector<std::string>> inverse3_ids(std::string_view text) {
  try {
    const Json message = parse(text);
    Vector<std::string> ids;
    if (const Json* devices = member(message, "inverse3", &Json::is_array)) {
      for (const Json& device : *devices) ids.push_back(id_of(device));
    }
    return ids;
  } catch (const Malformed&) {
    return std::nullopt;
  }
}

std::string force_command(const std::string& device_id, const Vec3& force) {
  const Vec3 f = to_haply(force);
  const Json values = {{"x", f.x()}, {"y", f.y()}, {"z", f.z()}};
  const Json device = {{"device_id", device_id}, {"commands", {{"set_cursor_force", {{"values", values}}}}}};
  return Json{{"inverse3", Json::array({device})}}.dump();
}

}  // namespace crumble::device
