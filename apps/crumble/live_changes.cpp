#include "live_changes.hpp"

#include <algorithm>

#include "crumble/base/text.hpp"
#include "crumble/sim/change.hpp"

namespace crumble::app {
namespace {

struct Field {
  const char* name;
  void (*set)(SimulationDef& def, double value);
};

constexpr Field kFields[] = {
    {"stiffness", [](SimulationDef& def, double value) { def.material.stiffness = value; }},
    {"damping_ratio", [](SimulationDef& def, double value) { def.material.damping_ratio = value; }},
    {"length_limit", [](SimulationDef& def, double value) { def.material.length_limit = value; }},
    {"mass", [](SimulationDef& def, double value) { def.material.mass = value; }},
    {"spring_damping", [](SimulationDef& def, double value) { def.material.spring_damping = value; }},
    {"gravity",
     [](SimulationDef& def, double value) {
       def.gravity = {0, -value, 0};
     }},
    {"cut_fade", [](SimulationDef& def, double value) { def.step.cut_fade = value; }},
    {"friction",
     [](SimulationDef& def, double value) {
       for (Tool& tool : def.tools) tool.friction = {value, value};
     }},
};

const Field* find(const std::string& name) {
  const auto* const field =
      std::find_if(std::begin(kFields), std::end(kFields), [&](const Field& f) { return f.name == name; });
  return field == std::end(kFields) ? nullptr : field;
}

}  // namespace

LiveChange parse_live_change(const std::string& text) {
  const std::size_t colon = text.find(':'), equals = text.find('=');
  if (colon != std::string::npos && equals != std::string::npos && colon < equals) {
    const auto time = parse_double(std::string_view(text).substr(0, colon));
    const auto value = parse_double(std::string_view(text).substr(equals + 1));
    const std::string field = text.substr(colon + 1, equals - colon - 1);
    if (time && value) {
      require_in_range("--change TIME", *time, 0, 1e9);
      if (find(field)) return {*time, field, *value};
      std::string names;
      for (const Field& f : kFields) names += std::string(" ") + f.name;
      throw Error(Code::unsupported, "--change '" + text + "': '" + field + "' cannot be changed; there are" + names);
    }
  }
  throw Error(Code::format, "--change '" + text + "' is not TIME:FIELD=VALUE, as 0.5:stiffness=60");
}

LiveChanges::LiveChanges(Vector<LiveChange> changes) : changes_(std::move(changes)) {
  std::stable_sort(changes_.begin(), changes_.end(), [](const auto& a, const auto& b) { return a.time < b.time; });
}

void LiveChanges::make_due(Simulation& sim, Recording& recording) {
  if (next_ == changes_.size() || changes_[next_].time > sim.info().time) return;
  SimulationDef def = sim.definition();
  for (; next_ < changes_.size() && changes_[next_].time <= sim.info().time; ++next_) {
    find(changes_[next_].field)->set(def, changes_[next_].value);
  }
  DefinitionChange change(sim.definition(), std::move(def));
  recording.add_change(Recording::settings_of(change.definition()));
  change.apply_to(sim);
}

}  // namespace crumble::app
