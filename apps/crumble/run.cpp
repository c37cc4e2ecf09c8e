#include <unistd.h>

#include <cstdio>
#include <vector>

#include "commands.hpp"
#include "crumble/base/memory.hpp"
#include "output.hpp"
#include "runner/measure.hpp"
#include "solver_options.hpp"

namespace crumble::app {
namespace {

struct RunOptions {
  std::string scene, device, preset = "default", precision;
  std::optional<double> seconds, tau;
  SolverOptions solver;
  std::uint32_t sleep_debris = 0, remove_debris = 0;
  std::vector<std::string> changes;
  std::string out;
  bool json = false;
};

void show_progress(double share) {
  if (isatty(STDERR_FILENO)) std::fprintf(stderr, "\r%3.0f %%", 100 * share);
}

DebrisOptions debris_options(const RunOptions& options) {
  if (options.sleep_debris > 0 && options.remove_debris > 0) {
    throw Error(Code::invalid_value, "--sleep-debris and --remove-debris exclude each other");
  }
  if (options.remove_debris > 0) return {{options.remove_debris}, FragmentState::removed};
  return {{options.sleep_debris}, FragmentState::asleep};
}

void run(const RunOptions& options) {
  const DebrisOptions debris = debris_options(options);
  std::optional<Precision> precision;
  if (!options.precision.empty()) precision = bench::parse_precision(options.precision);
  check(options.solver);
  if (options.preset != "default" && options.preset != "paper") {
    throw Error(Code::unsupported, "--preset '" + options.preset + "' is not known; there are: default paper");
  }
  if (options.tau) {
    require_positive("--dt", *options.tau);
    require_in_range("--dt", *options.tau, 0, kMaxTimeStep);
  }
  Vector<LiveChange> changes;
  for (const std::string& text : options.changes) changes.push_back(parse_live_change(text));
  std::optional<OutputFolder> folder;
  if (!options.out.empty()) folder.emplace(options.out);
  Scene scene = load_scene(options.scene, options.preset == "paper" ? Preset::paper : Preset::standard);
  if (options.tau) scene.def.step.tau = *options.tau;
  if (precision) scene.def.step.precision = *precision;
  apply(options.solver, scene.def.step);
  const Experiment experiment =
      run_experiment(std::move(scene), options.device, options.seconds, debris, LiveChanges(changes), show_progress);
  const Rerun again =
      rerun(experiment.recording, experiment.scene.def.step, folder ? phase_steps(experiment) : Vector<std::size_t>{});
  if (isatty(STDERR_FILENO)) std::fprintf(stderr, "\r      \r");
  if (folder) write_outputs(experiment, again, *folder);
  const std::string text = options.json ? to_json(experiment, again) : to_report(experiment, again, options.out);
  std::fputs(text.c_str(), stdout);
}

}  // namespace

void add_run(CLI::App& app) {
  auto* command = app.add_subcommand("run", "Run a scene and report force, fracture and step time");
  auto options = std::make_shared<RunOptions>();
  std::string names;
  for (const std::string& name : scene_names()) names += " " + name;
  command->add_option("scene", options->scene, "JSON file or built-in scene:" + names)->required();
  command->add_option("--device", options->device, "press:MM_PER_S or replay:FILE; else what the scene says");
  command->add_option("--seconds", options->seconds, "Simulated time; else until the motion is over");
  command->add_option("--dt", options->tau, "Time step tau, s");
  command->add_option("--preset", options->preset, "default or paper")->capture_default_str();
  command->add_option("--precision", options->precision, "float64 or float32; else what the scene says");
  add_options(*command, options->solver);
  command->add_option("--sleep-debris", options->sleep_debris,
                      "Let fragments of up to so many nodes sleep once at rest");
  command->add_option("--remove-debris", options->remove_debris,
                      "Remove fragments of up to so many nodes once at rest");
  command->add_option("--change", options->changes,
                      "TIME:FIELD=VALUE, s and SI units: another stiffness, damping_ratio, length_limit, mass, "
                      "spring_damping, gravity, cut_fade or friction of the tools from then on; may be repeated");
  command->add_option("--out", options->out,
                      "Folder for force.csv, events.csv, force.svg, phases*.png, surface_*.ply, experiment.crec");
  command->add_flag("--json", options->json, "Print one JSON object instead of the report");
  command->callback([options] { run(*options); });
}

}  // namespace crumble::app
