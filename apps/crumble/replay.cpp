#include <algorithm>
#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "commands.hpp"
#include "output.hpp"
#include "solver_options.hpp"

namespace crumble::app {
namespace {

// Exit code 1 when a state differs.
void replay_recording(const std::string& path, const SolverOptions& solver, bool json) {
  check(solver);
  StepSettings how;
  apply(solver, how);
  const Recording recording = Recording::load(path);
  Simulation sim = recording.start(how);
  const auto differs = replay(recording, sim);
  if (json) {
    nlohmann::ordered_json result{{"steps", recording.step_count()},
                                  {"identical", !differs},
                                  {"state_hash", hash_text(sim.state_hash())},
                                  {"cuts", sim.counters().cuts},
                                  {"precision", precision_text(sim)},
                                  {"kernel", sim.kernel()},
                                  {"threads", how.threads}};
    if (differs) result["first_difference"] = *differs;
    std::puts(result.dump(1).c_str());
  } else if (!differs) {
    std::printf("%zu steps run again (%s), every state hash identical, %llu springs cut\n", recording.step_count(),
                solver_text(sim).c_str(), static_cast<unsigned long long>(sim.counters().cuts));
  }
  if (differs) {
    throw Error(Code::diverged, "recording '" + path + "': the state differs from the recorded one at step " +
                                    std::to_string(*differs));
  }
}

struct ExportOptions {
  std::string recording, out;
  double at = 0;
};

void export_surface(const ExportOptions& options) {
  require_surface_extension(options.out);
  const Recording recording = Recording::load(options.recording);
  const StepSettings settings = recording.start().definition().step;
  const double tick = settings.tau * settings.iterations;
  const double last = static_cast<double>(recording.step_count()) * tick;
  require_in_range("--at", options.at, 0, last);
  if (recording.step_count() == 0) throw Error(Code::empty, "recording '" + options.recording + "' has no step");
  const auto step = static_cast<std::size_t>(std::max(std::floor(options.at / tick + 0.5), 1.0)) - 1;
  const Rerun again = rerun(recording, {}, {std::min(step, recording.step_count() - 1)});
  write_surface(again.captures.at(0), options.out);
}

}  // namespace

void add_replay(CLI::App& app) {
  auto* command = app.add_subcommand("replay", "Run a recording again and verify every state hash");
  auto path = std::make_shared<std::string>();
  auto solver = std::make_shared<SolverOptions>();
  auto json = std::make_shared<bool>(false);
  command->add_option("recording", *path, "A file that `run --out` wrote")->required();
  add_options(*command, *solver);
  command->add_flag("--json", *json, "Print one JSON object");
  command->callback([path, solver, json] { replay_recording(*path, *solver, *json); });
}

void add_export(CLI::App& app) {
  auto* command = app.add_subcommand("export", "Write the surface that a recording has at a given time");
  auto options = std::make_shared<ExportOptions>();
  command->add_option("recording", options->recording, "A file that `run --out` wrote")->required();
  command->add_option("--at", options->at, "Simulated seconds from the recording's start")->required();
  command->add_option("--out", options->out, "Surface file by extension")->required();
  command->callback([options] { export_surface(*options); });
}

}  // namespace crumble::app
