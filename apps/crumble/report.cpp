#include <algorithm>
#include <cstdio>
#include <fstream>
#include <nlohmann/json.hpp>

#include "crumble/base/memory.hpp"
#include "output.hpp"
#include "render/text_curve.hpp"

namespace crumble::app {
namespace {

using Json = nlohmann::ordered_json;

// How often 300 Hz fits into the 99th percentile of a step's CPU time.
double rate_multiple(const bench::Percentiles& cost) {
  return 1e6 / (cost.p99 * 300);
}

Json to_array(const Vec3& v) {
  return {v.x(), v.y(), v.z()};
}

Json counters(const Experiment& experiment) {
  const Counters& c = experiment.sim.counters();
  return {{"guarded_nodes", c.guarded_nodes},
          {"substeps_per_step", experiment.sim.coefficients().substeps},
          {"tool_jumps", c.tool_jumps},
          {"suspended_steps", c.suspended_steps},
          {"bad_poses", c.bad_poses},
          {"asleep", c.asleep},
          {"woken", c.woken},
          {"removed", c.removed},
          {"removed_nodes", c.removed_nodes},
          {"dropped_events", c.dropped_events},
          {"inverted_tetrahedra", count_inverted(experiment.sim)},
          {"clamped", 0},
          {"truncated", 0},
          {"dropped", 0}};
}

std::size_t count_events(const Experiment& experiment, EventKind kind) {
  return static_cast<std::size_t>(std::count_if(experiment.events.begin(), experiment.events.end(),
                                                [&](const Event& event) { return event.kind == kind; }));
}

Json events(const Experiment& experiment) {
  return {{"cut", count_events(experiment, EventKind::cut)},
          {"split", count_events(experiment, EventKind::split)},
          {"contact_begin", count_events(experiment, EventKind::contact_begin)},
          {"contact_end", count_events(experiment, EventKind::contact_end)}};
}

double released_energy(const Experiment& experiment) {
  double energy = 0;
  for (const Event& event : experiment.events) energy += event.kind == EventKind::cut ? event.energy : 0;
  return energy;
}

// Nodes of the largest fragment.
std::uint32_t largest_fragment(const Simulation& sim) {
  std::uint32_t largest = 0;
  for (std::uint32_t f = 0; f < sim.fragments().count(); ++f) {
    largest = std::max(largest, sim.fragments().record(f).node_count);
  }
  return largest;
}

Json ledger(const EnergyLedger& l) {
  return {{"stored_j", l.stored},
          {"tool_work_j", l.tool_work},
          {"external_work_j", l.external_work},
          {"dissipated_j", l.dissipated},
          {"cut_j", l.cut}};
}

Json layout(const Simulation& sim) {
  const LayoutReport l = sim.layout();
  const auto springs = static_cast<double>(sim.mesh().springs.size());
  return {{"lane_use", springs / static_cast<double>(l.lanes)},
          {"share_in_segments", static_cast<double>(l.springs_in_segments) / springs},
          {"segments", l.segments},
          {"batches", l.batches},
          {"partitions", l.partitions},
          {"sorted", l.sorted}};
}

std::string processor() {
  std::ifstream info("/proc/cpuinfo");
  for (std::string line; std::getline(info, line);) {
    if (line.starts_with("model name")) return line.substr(line.find(':') + 2);
  }
  return "unknown processor";
}

template <class... Values>
std::string line(const char* format, Values... values) {
  char text[400];
  std::snprintf(text, sizeof text, format, values...);
  return text;
}

std::string layout_line(const Simulation& sim) {
  const LayoutReport l = sim.layout();
  const auto springs = static_cast<double>(sim.mesh().springs.size());
  return line("layout      %.0f %% of the springs in segments, %zu in batches, lane use %.2f, %u partition%s\n",
              100 * static_cast<double>(l.springs_in_segments) / springs,
              sim.mesh().springs.size() - l.springs_in_segments, springs / static_cast<double>(l.lanes), l.partitions,
              l.partitions == 1 ? "" : "s");
}

std::string curve(const Experiment& experiment, std::size_t tool) {
  const bool over_time = !is_press(experiment.scene) || experiment.scene.motions[0].trajectory;
  Vector<double> x, y;
  for (const Sample& s : experiment.samples) {
    x.push_back(over_time ? s.time : 1e3 * s.tools[tool].depth);
    y.push_back(norm(s.tools[tool].wrench.force));
  }
  const std::string label = "force on " + tool_name(experiment.scene, tool) + ", N";
  return render::text_curve(x, y, 76, 10, {over_time ? "time, s" : "depth, mm", label});
}

Json force(const Experiment& experiment, std::size_t tool) {
  Json rows = Json::array();
  for (const Sample& s : experiment.samples) {
    rows.push_back({{"time_s", s.time},
                    {"depth_mm", 1e3 * s.tools[tool].depth},
                    {"force_n", to_array(s.tools[tool].wrench.force)},
                    {"torque_nm", to_array(s.tools[tool].wrench.torque)}});
  }
  return rows;
}

}  // namespace

std::string precision_text(const Simulation& sim) {
  return sim.definition().step.precision == Precision::float32 ? "float32" : "float64";
}

std::string solver_text(const Simulation& sim) {
  const std::uint32_t threads = sim.definition().step.threads;
  return precision_text(sim) + ", " + sim.kernel() + " kernel, " + std::to_string(threads) +
         (threads == 1 ? " thread" : " threads");
}

std::string hash_text(std::uint64_t hash) {
  return line("%016llx", static_cast<unsigned long long>(hash));
}

std::string to_json(const Experiment& experiment, const Rerun& again) {
  const TetMesh& mesh = experiment.sim.mesh();
  Json json;
  json["scene"] = experiment.scene.name;
  json["device"] = experiment.device;
  json["resampled"] = experiment.resampled;
  json["nodes"] = mesh.node_count();
  json["surface_nodes"] = mesh.surface_node_count();
  json["springs"] = mesh.springs.size();
  json["tetrahedra"] = mesh.tetrahedra.size();
  json["tau_s"] = experiment.scene.def.step.tau;
  json["steps"] = experiment.samples.size();
  json["cuts"] = experiment.sim.counters().cuts;
  json["fragments"] = count_fragments(experiment.sim);
  json["largest_fragment_nodes"] = largest_fragment(experiment.sim);
  json["events"] = events(experiment);
  json["cut_energy_j"] = released_energy(experiment);
  json["peak_force_n"] = experiment.peak_forces[0];
  json["force"] = force(experiment, 0);
  json["other_tools"] = Json::array();
  for (std::size_t tool = 1; tool < experiment.peak_forces.size(); ++tool) {
    json["other_tools"].push_back({{"peak_force_n", experiment.peak_forces[tool]}, {"force", force(experiment, tool)}});
  }
  const bench::Percentiles& cost = experiment.cost;
  json["step_cpu_us"] = {{"p50", cost.p50}, {"p99", cost.p99}, {"p99_9", cost.p99_9}, {"max", cost.max}};
  json["rate_multiple_of_300hz"] = rate_multiple(cost);
  json["energy_gain_max_relative"] = again.ledger.gain_max_relative;
  json["energy_ledger"] = ledger(again.ledger);
  json["precision"] = precision_text(experiment.sim);
  json["kernel"] = experiment.sim.kernel();
  json["threads"] = experiment.sim.definition().step.threads;
  json["layout"] = layout(experiment.sim);
  json["state_hash"] = hash_text(experiment.sim.state_hash());
  json["counters"] = counters(experiment);
  json["warnings"] = experiment.scene.warnings;
  return json.dump(1) + "\n";
}

std::string to_report(const Experiment& experiment, const Rerun& again, const std::filesystem::path& folder) {
  const TetMesh& mesh = experiment.sim.mesh();
  const Material& m = experiment.scene.def.material;
  const StepSettings& step = experiment.scene.def.step;
  std::string text;
  text += line("%s: %s\n\n", experiment.scene.name.c_str(), experiment.scene.description.c_str());
  text += line("machine     %s\n", processor().c_str());
  text += line(
      "mesh        %zu nodes (%zu on the surface), %zu springs, %zu tetrahedra, dihedral angles %.1f to %.1f degrees\n",
      mesh.node_count(), mesh.surface_node_count(), mesh.springs.size(), mesh.tetrahedra.size(),
      experiment.scene.quality.dihedral_min, experiment.scene.quality.dihedral_max);
  text += line("material    k = %g N/m, alpha = %g, l_p = %g, %g g; step of %g ms\n", m.stiffness, m.damping_ratio,
               m.length_limit, 1e3 * m.mass, 1e3 * step.tau);
  text += line("motion      %s%s, %zu steps\n", experiment.device.c_str(), experiment.resampled ? ", resampled" : "",
               experiment.samples.size());
  text += layout_line(experiment.sim);
  text += line("step        %s: CPU p50 %.1f us, p99 %.1f us, max %.1f us: %.0f times the 300 Hz that a hand needs\n",
               solver_text(experiment.sim).c_str(), experiment.cost.p50, experiment.cost.p99, experiment.cost.max,
               rate_multiple(experiment.cost));
  const std::size_t fragments = count_fragments(experiment.sim);
  text += line("fracture    %llu springs cut, which held %.2f mJ; %zu fragment%s, the largest of %u nodes\n",
               static_cast<unsigned long long>(experiment.sim.counters().cuts), 1e3 * released_energy(experiment),
               fragments, fragments == 1 ? "" : "s", largest_fragment(experiment.sim));
  text += "force       peak";
  for (std::size_t tool = 0; tool < experiment.peak_forces.size(); ++tool) {
    text += line("%s %.2f N on %s", tool == 0 ? "" : ",", experiment.peak_forces[tool],
                 tool_name(experiment.scene, tool).c_str());
  }
  text += "\n";
  text +=
      line("energy      greatest gain of a solve %.1e of the scale; %llu nodes guarded\n",
           again.ledger.gain_max_relative, static_cast<unsigned long long>(experiment.sim.counters().guarded_nodes));
  text += line("state hash  %s, the same in a second run\n\n", hash_text(experiment.sim.state_hash()).c_str());
  for (const std::string& warning : experiment.scene.warnings) text += "warning: " + warning + "\n";
  for (std::size_t tool = 0; tool < experiment.peak_forces.size(); ++tool) text += curve(experiment, tool);
  if (!folder.empty()) {
    text += "\npictures    " + (folder / "phases.png").string() + "\n            " + (folder / "force.svg").string() +
            "\nall files   " + folder.string() + "\n";
  }
  return text;
}

}  // namespace crumble::app
