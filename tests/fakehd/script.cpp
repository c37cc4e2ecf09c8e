// JSON to Script. A key that nobody knows is refused: a typo must not silently test nothing.
#include <cstdlib>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>
#include <stdexcept>

#include "fakehd_script.hpp"

namespace fakehd {
namespace {

using nlohmann::json;

[[noreturn]] void fail(const std::string& text) {
  throw std::runtime_error(text);
}

/// The keys of one object, taken one by one; what is left over at the end is wrong.
class Fields {
 public:
  Fields(const json& object, std::string name) : object_(object), name_(std::move(name)) {
    if (!object_.is_object()) fail(name_ + " must be an object");
  }

  const json* find(const char* key) {
    known_.insert(key);
    const auto at = object_.find(key);
    return at == object_.end() ? nullptr : &*at;
  }

  template <class T>
  void take(const char* key, T& value) {
    const json* found = find(key);
    if (!found) return;
    try {
      found->get_to(value);
    } catch (const json::exception& e) {
      fail(name_ + "." + key + ": " + e.what());
    }
  }

  /// Of a finite number not below `least`.
  void take_number(const char* key, double& value, double least) {
    take(key, value);
    if (!std::isfinite(value) || value < least) fail(name_ + "." + key + " must be at least " + std::to_string(least));
  }

  template <class T>
  void take_word(const char* key, T& value, const std::map<std::string, T>& words) {
    std::string word;
    take(key, word);
    if (!object_.contains(key)) return;
    const auto at = words.find(word);
    if (at == words.end()) fail(name_ + "." + key + ": nothing is called '" + word + "'");
    value = at->second;
  }

  void finish() const {
    for (const auto& item : object_.items()) {
      if (!known_.contains(item.key())) fail(name_ + "." + item.key() + " is no key");
    }
  }

 private:
  const json& object_;
  std::string name_;
  std::set<std::string> known_;
};

Hand read_hand(const json& object) {
  Hand hand;
  Fields fields(object, "hand");
  fields.take_number("mass", hand.mass, 1e-6);
  fields.take_number("stiffness", hand.stiffness, 0);
  fields.take_number("damping", hand.damping, 0);
  if (const json* points = fields.find("points")) {
    hand.points.clear();
    for (const json& item : *points) {
      HandPoint point;
      Fields parts(item, "hand.points");
      parts.take_number("t", point.t, hand.points.empty() ? 0 : hand.points.back().t);
      parts.take("x", point.at[0]);
      parts.take("y", point.at[1]);
      parts.take("z", point.at[2]);
      parts.finish();
      hand.points.push_back(point);
    }
    if (hand.points.empty()) fail("hand.points is empty");
  }
  fields.finish();
  // Substeps of a sixteenth of the slowest tick, 10 ms: bounded while k h^2 + 2 b h < 4 m.
  const double h = 0.01 / 16;
  if ((hand.stiffness * h + 2 * hand.damping) * h >= 4 * hand.mass) fail("hand.mass is too small to be integrated");
  return hand;
}

void read_calibration(Fields& fields, DeviceScript& device) {
  fields.take_word<Calibration>("calibration", device.calibration,
                                {{"none", Calibration::none},
                                 {"encoder_reset", Calibration::encoder_reset},
                                 {"auto", Calibration::automatic},
                                 {"inkwell", Calibration::inkwell}});
  fields.take("inkwell_at_s", device.inkwell_at);
  fields.take_number("inkwell_for_s", device.inkwell_for, 0);
  fields.take_number("auto_after_s", device.auto_after, 0);
  fields.take("uncalibrated_mm", device.uncalibrated);
}

void read_limits(Fields& fields, DeviceScript& device) {
  fields.take_number("max_force", device.max_force, 0);
  fields.take_number("continuous_force", device.continuous_force, 1e-9);
  fields.take_number("max_stiffness", device.max_stiffness, 0);
  fields.take_number("max_damping", device.max_damping, 0);
  fields.take_number("velocity_limit", device.velocity_limit, 0);
  fields.take_number("impulse_limit", device.impulse_limit, 0);
  fields.take("workspace", device.workspace);
  fields.take_number("position_step_mm", device.position_step, 0);
  fields.take_number("ramp_s", device.ramp_time, 0);
  fields.take_number("temperature", device.temperature, 0);
  fields.take_number("thermal_time_s", device.thermal_time, 1e-3);
}

DeviceScript read_device(const json& object, std::size_t index) {
  DeviceScript device;
  device.name = index == 0 ? "Default Device" : "Device " + std::to_string(index + 1);
  Fields fields(object, "devices[" + std::to_string(index) + "]");
  fields.take("name", device.name);
  fields.take("model", device.model);
  fields.take("serial", device.serial);
  fields.take("input_dof", device.input_dof);
  fields.take("output_dof", device.output_dof);
  if (device.output_dof != 3 && device.output_dof != 6) fail("output_dof must be 3 or 6");
  if (device.model.find("FAKE") == std::string::npos) device.model = "FAKE " + device.model;
  read_limits(fields, device);
  read_calibration(fields, device);
  if (const json* hand = fields.find("hand")) device.hand = read_hand(*hand);
  std::string path;
  fields.take("trajectory", path);
  if (!path.empty()) device.trajectory = read_trajectory(path);
  fields.finish();
  return device;
}

Fault read_fault(const json& object, const Script& script) {
  static const std::map<std::string, FaultKind> kinds = {{"comm_error", FaultKind::comm_error},
                                                         {"device_fault", FaultKind::device_fault},
                                                         {"timer_error", FaultKind::timer_error},
                                                         {"warm_motors", FaultKind::warm_motors},
                                                         {"exceeded_force", FaultKind::exceeded_force},
                                                         {"exceeded_velocity", FaultKind::exceeded_velocity},
                                                         {"nan_position", FaultKind::nan_position},
                                                         {"inf_velocity", FaultKind::inf_velocity},
                                                         {"teleport", FaultKind::teleport},
                                                         {"freeze", FaultKind::freeze},
                                                         {"bad_transform", FaultKind::bad_transform},
                                                         {"init_error", FaultKind::init_error},
                                                         {"error", FaultKind::error}};
  Fault fault;
  Fields fields(object, "faults");
  fields.take_word("kind", fault.kind, kinds);
  fields.take("tick", fault.tick);
  fields.take("count", fault.count);
  fields.take("code", fault.code);
  fields.take("internal", fault.internal);
  if (const json* device = fields.find("device"); device && device->is_string()) {
    const auto same = [&](const DeviceScript& d) { return d.name == device->get<std::string>(); };
    while (fault.device < script.devices.size() && !same(script.devices[fault.device])) ++fault.device;
  } else {
    fields.take("device", fault.device);
  }
  if (fault.device >= script.devices.size()) fail("faults.device names no device");
  if (fault.kind == FaultKind::error && fault.code == 0) fail("faults.code is missing");
  fields.finish();
  return fault;
}

Script read_script(const json& object) {
  Script script;
  Fields fields(object, "script");
  if (const json* devices = fields.find("devices")) {
    for (const json& item : *devices) script.devices.push_back(read_device(item, script.devices.size()));
  } else {
    script.devices.push_back(read_device(json::object(), 0));
  }
  fields.take("default_names", script.default_names);
  fields.take("manual", script.manual);
  fields.take("null_name_fails", script.null_name_fails);
  fields.take("license_refused", script.license_refused);
  fields.take_number("stall_limit_s", script.stall_limit, 0);
  fields.take("transform_skew", script.transform_skew);
  fields.take_word<RateQuirk>(
      "rate_quirk", script.rate_quirk,
      {{"value", RateQuirk::value}, {"timer", RateQuirk::timer}, {"operation", RateQuirk::operation}});
  fields.take("rates", script.rates);
  for (const unsigned long rate : script.rates) {
    if (rate < 100 || rate > 100000) fail("script.rates must lie in 100 to 100000");
  }
  fields.take("scheduler_slots", script.scheduler_slots);
  if (const json* faults = fields.find("faults")) {
    for (const json& item : *faults) script.faults.push_back(read_fault(item, script));
  }
  fields.finish();
  return script;
}

std::string text_of(const std::string& text) {
  const std::size_t first = text.find_first_not_of(" \t\r\n");
  if (first != std::string::npos && text[first] == '{') return text;
  std::ifstream file(text);
  if (!file) fail("cannot read the script " + text);
  std::stringstream all;
  all << file.rdbuf();
  return all.str();
}

}  // namespace

Script parse_script(const char* text) {
  if (!text) return read_script(json::object());
  return read_script(json::parse(text_of(text)));
}

}  // namespace fakehd
