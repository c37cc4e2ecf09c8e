#include "zwidth_report.hpp"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "crumble/base/memory.hpp"
#include "crumble/base/text.hpp"
#include "line.hpp"

namespace crumble::app {
namespace {

using Json = nlohmann::ordered_json;

struct Summary {
  std::size_t passed = 0, warned = 0;  // warned: of those that fail, the loop had told that damping is short
  double least_energy = 0;             // J
  double span = 0, speed = 0;          // m, m/s, in the hold, the greatest
};

Summary summarize(const Vector<Press>& presses) {
  Summary s;
  for (const Press& p : presses) {
    const bool passes = p.passes();
    s.passed += passes;
    s.warned += !passes && p.outcome.capped > 0;
    s.least_energy = std::min(s.least_energy, p.outcome.least_energy);
    s.span = std::max(s.span, p.outcome.hold_span);
    s.speed = std::max(s.speed, p.outcome.hold_speed);
  }
  return s;
}

Json case_json(const Press& p) {
  const closed_loop::Case& c = p.what;
  return {{"grip", c.grip.name},
          {"spring_stiffness_n_m", c.spring_stiffness},
          {"tick_s", c.tick},
          {"mean", c.mean},
          {"delay_ticks", c.delay},
          {"body_ticks", p.setup.body_ticks},
          {"coupling_stiffness_n_m", p.setup.coupling_stiffness}};
}

Json press_json(const Press& p) {
  const closed_loop::Outcome& o = p.outcome;
  Json json = case_json(p);
  json.update({{"passes", p.passes()},
               {"why", closed_loop::failure(o, p.setup)},
               {"excess", closed_loop::excess(o, p.setup)},
               {"least_energy_j", o.least_energy},
               {"observed_least_j", o.observed_least},
               {"hold_speed_m_s", o.hold_speed},
               {"hold_span_m", o.hold_span},
               {"hold_force_span_n", o.hold_force_span},
               {"hold_cuts", o.hold_cuts},
               {"cuts", o.cuts},
               {"peak_force_n", o.peak_force},
               {"depth_m", o.depth},
               {"felt_stiffness_n_m", o.stiffness},
               {"required_damping_n_s_m", o.required_damping},
               {"capped_ticks", o.capped},
               {"fault", to_string(o.fault)}});
  return json;
}

Json presses_json(const Vector<Press>& presses) {
  Json list = Json::array();
  for (const Press& p : presses) list.push_back(press_json(p));
  return list;
}

Json setup_json(const SetupPresses& row) {
  const Summary s = summarize(row.presses);
  return {{"setup", row.name},
          {"passed", s.passed},
          {"of", row.presses.size()},
          {"failed_warned", s.warned},
          {"least_energy_j", s.least_energy},
          {"hold_span_m", s.span},
          {"hold_speed_m_s", s.speed},
          {"combinations", presses_json(row.presses)}};
}

Json maps_json(const Vector<StabilityMap>& maps) {
  Json list = Json::array();
  for (const StabilityMap& map : maps) {
    Json json{{"title", map.title}, {"stiffnesses_n_m", map.stiffnesses}, {"rates_hz", map.rates}};
    json["largest_stable_n_m"] = map.largest_stable();
    if (!map.chosen.empty()) json["chosen_n_m"] = map.chosen;
    json["cells"] = presses_json(map.presses);
    list.push_back(std::move(json));
  }
  return list;
}

std::string setup_line(const SetupPresses& row) {
  const Summary s = summarize(row.presses);
  const std::size_t of = row.presses.size();
  const std::string warned = s.passed == of ? "" : std::to_string(s.warned) + " of " + std::to_string(of - s.passed);
  return line("%-36s %3zu of %-3zu %9s %12.1e %10.3f %12.3f\n", row.name.c_str(), s.passed, of, warned.c_str(),
              s.least_energy, 1e3 * s.span, 1e3 * s.speed);
}

// A cell of a CSV file.
std::string cell(const Json& value) {
  if (!value.is_string()) return value.is_number_float() ? to_text(value.get<double>()) : value.dump();
  return '"' + value.get<std::string>() + '"';
}

}  // namespace

std::string to_json(const ZWidth& zwidth) {
  Json json{{"quick", zwidth.quick}, {"setups", Json::array()}};
  for (const SetupPresses& row : zwidth.setups) json["setups"].push_back(setup_json(row));
  json["body_maps"] = maps_json(zwidth.body);
  json["coupling_maps"] = maps_json(zwidth.coupling);
  return json.dump(1) + "\n";
}

std::string to_report(const ZWidth& zwidth) {
  std::string text =
      line("%-36s %10s %9s %12s %10s %12s\n", "setup", "passed", "warned", "energy, J", "span, mm", "speed, mm/s");
  for (const SetupPresses& row : zwidth.setups) text += setup_line(row);
  text +=
      "\nwarned: of those that fail, where the loop had told that the device does not bear the damping\n"
      "energy, span and speed: the worst of the row; of the span in the hold an encoder allows three steps\n";
  for (const SetupPresses& row : zwidth.setups) {
    for (const Press& p : row.presses) {
      if (p.passes()) continue;
      text += "\n" + row.name + ": " + to_string(p.what) + ": " + closed_loop::failure(p.outcome, p.setup);
    }
  }
  return text + "\n";
}

std::string combination_table(const ZWidth& zwidth) {
  std::string text;
  for (const SetupPresses& row : zwidth.setups) {
    for (const Press& p : row.presses) {
      const Json json = press_json(p);
      if (text.empty()) {
        text = "setup";
        for (const auto& [key, value] : json.items()) text += ',' + key;
        text += '\n';
      }
      text += '"' + row.name + '"';
      for (const auto& [key, value] : json.items()) text += ',' + cell(value);
      text += '\n';
    }
  }
  return text;
}

}  // namespace crumble::app
