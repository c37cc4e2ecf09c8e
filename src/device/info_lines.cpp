#include "device/info_lines.hpp"

#include <algorithm>
#include <array>
#include <utility>

#include "crumble/base/error.hpp"
#include "crumble/base/memory.hpp"
#include "crumble/base/text.hpp"

namespace crumble::device {
namespace {

constexpr std::array<std::pair<std::uint32_t, const char*>, 7> kQuantities = {{
    {quantity::kPosition, "position"},
    {quantity::kOrientation, "orientation"},
    {quantity::kLinearVelocity, "linear velocity"},
    {quantity::kAngularVelocity, "angular velocity"},
    {quantity::kButtons, "buttons"},
    {quantity::kForce, "force"},
    {quantity::kTorque, "torque"},
}};

constexpr std::array<std::pair<const char*, double DeviceInfo::*>, 8> kLimits = {{
    {"max_force_n", &DeviceInfo::max_force},
    {"continuous_force_n", &DeviceInfo::continuous_force},
    {"max_stiffness_n_per_m", &DeviceInfo::max_stiffness},
    {"max_damping_n_s_per_m", &DeviceInfo::max_damping},
    {"max_speed_m_per_s", &DeviceInfo::max_speed},
    {"mass_kg", &DeviceInfo::mass},
    {"friction_damping_n_s_per_m", &DeviceInfo::friction_damping},
    {"position_step_m", &DeviceInfo::position_step},
}};

std::string measured_text(std::uint32_t measured) {
  std::string text;
  for (const auto& [bit, name] : kQuantities) {
    if (measured & bit) text += (text.empty() ? "" : ", ") + std::string(name);
  }
  return text;
}

std::uint32_t read_measured(std::string_view text) {
  std::uint32_t measured = 0;
  while (!text.empty()) {
    const std::string_view name = text.substr(0, text.find(", "));
    const auto* known =
        std::find_if(kQuantities.begin(), kQuantities.end(), [&](const auto& q) { return q.second == name; });
    if (known == kQuantities.end()) {
      throw Error(Code::format, "trajectory header: measured has '" + std::string(name) + "', which is no quantity");
    }
    measured |= known->first;
    text.remove_prefix(std::min(text.size(), name.size() + 2));
  }
  return measured;
}

}  // namespace

Vector<std::string> info_lines(const DeviceInfo& info) {
  Vector<std::string> lines = {"measured: " + measured_text(info.measured)};
  for (const auto& [name, limit] : kLimits) {
    if (info.*limit > 0) lines.push_back(std::string(name) + ": " + to_text(info.*limit));
  }
  return lines;
}

void read_info_lines(const Trajectory& trajectory, DeviceInfo& info) {
  if (const std::string_view text = trajectory.value_of("measured"); !text.empty()) info.measured = read_measured(text);
  for (const auto& [name, limit] : kLimits) {
    const std::string_view text = trajectory.value_of(name);
    if (text.empty()) continue;
    const auto value = parse_double(text);
    if (!value || !(*value >= 0)) {
      throw Error(Code::format, std::string("trajectory header: ") + name + " is '" + std::string(text) +
                                    "', not a number from 0 on");
    }
    info.*limit = *value;
  }
}

}  // namespace crumble::device
