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

}  // namespace crumble::app
