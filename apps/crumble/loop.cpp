#include <cstdio>

#include "commands.hpp"
#include "crumble/base/memory.hpp"
#include "loop_replay.hpp"
#include "loop_report.hpp"
#include "output.hpp"
#include "runner/choice.hpp"

namespace crumble::app {
namespace {

constexpr std::array kCouplings{BodyCoupling::direct, BodyCoupling::local_model, BodyCoupling::paper};

struct LoopOptions {
  std::string scene, coupling = "direct", record, out;
  LoopSettings settings;
  int body_ticks = 1;
  std::optional<double> encoder;  // mm
  bool no_virtual_coupling = false, no_damping = false, json = false, verify = false;
};

BodyCoupling parse_coupling(const std::string& name) {
  Vector<std::string> names;
  for (const BodyCoupling coupling : kCouplings) names.emplace_back(to_string(coupling));
  bench::require_choice("--coupling", name, names);
  return kCouplings[static_cast<std::size_t>(std::ranges::find(names, name) - names.begin())];
}

LoopSettings settings_of(const LoopOptions& options) {
  LoopSettings settings = options.settings;
  settings.coupling = parse_coupling(options.coupling);
  require_in_range("--body-ticks", options.body_ticks, 1, 100);
  settings.body_ticks = static_cast<std::uint32_t>(options.body_ticks);
  settings.virtual_coupling = !options.no_virtual_coupling;
  settings.damping = !options.no_damping;
  if (options.encoder) {
    require_positive("--encoder", *options.encoder);
    settings.device.encoder_step = *options.encoder * 1e-3;
  }
  settings.record = !options.record.empty();
  check(settings);
  return settings;
}

// Exit code 1 when something differs.
void verify(const LoopOptions& options, const LoopSettings& settings) {
  constexpr std::string_view kReplay = "replay:";
  if (!settings.device.name.starts_with(kReplay)) {
    throw Error(Code::state, "--verify needs --device replay:FILE, which is '" + settings.device.name + "'");
  }
  const Trajectory trajectory = load_trajectory(settings.device.name.substr(kReplay.size()));
  const LoopReplay replay = verify_loop(load_scene(options.scene, Preset::standard), settings, trajectory);
  std::printf("%zu ticks run again: every force the same to the last bit, and %llu events, and the state %s\n",
              replay.rows, static_cast<unsigned long long>(replay.events), hash_text(replay.state_hash).c_str());
}

void loop(const LoopOptions& options) {
  const LoopSettings settings = settings_of(options);
  if (settings.record && std::filesystem::path(options.record).extension() != ".ctraj") {
    throw Error(Code::unsupported, "--record '" + options.record + "' must end in .ctraj");
  }
  if (options.verify) return verify(options, settings);
  std::optional<OutputFolder> folder;
  if (!options.out.empty()) folder.emplace(options.out);
  LoopRun run = run_loop(load_scene(options.scene, Preset::standard), settings);
  if (run.trajectory && !run.settings.body_thread) {
    run.replay = replay_loop(load_scene(options.scene, Preset::standard), run.settings, *run.trajectory);
    if (!run.replay->first_difference) add_loop_lines(run.scene, run.settings, *run.replay, *run.trajectory);
  }
  if (folder) write_loop(run, *folder);
  if (run.trajectory) write_trajectory(options.record, *run.trajectory);
  if (folder) folder->commit();
  std::fputs((options.json ? to_json(run) : to_report(run)).c_str(), stdout);
}

}  // namespace

void add_loop(CLI::App& app) {
  auto* command = app.add_subcommand("loop", "Run a scene in a haptic loop, in real time, and report how it went");
  auto options = std::make_shared<LoopOptions>();
  LoopSettings& settings = options->settings;
  command->add_option("scene", options->scene, "JSON file or built-in scene")->required();
  command->add_option("--device", settings.device.name, kDeviceHelp)->capture_default_str();
  command->add_option("--library", settings.device.library, "HDAPI, for phantom; else where its installer puts it");
  command->add_option("--coupling", options->coupling, "direct, local_model or paper")->capture_default_str();
  command->add_option("--body-ticks", options->body_ticks, "Ticks to a step of the body")->capture_default_str();
  command->add_flag("--body-thread", settings.body_thread, "Step the body in a thread of its own");
  command->add_option("--rate", settings.device.rate, "Ticks a second")->capture_default_str();
  command->add_option("--seconds", settings.seconds, "Time; else until the device's motion is over");
  command->add_flag("--no-virtual-coupling", options->no_virtual_coupling, "The device carries the tool rigidly");
  command->add_flag("--no-damping", options->no_damping, "Inject no damping");
  command->add_flag("--controller", settings.controller, "Brake when the energy ledger is in debt");
  command->add_option("--encoder", options->encoder, "Step of the hand's encoders, mm; else none");
  command->add_option("--record", options->record, "File for the device's motion and forces, .ctraj");
  command->add_flag("--verify", options->verify,
                    "Run what replay:FILE recorded again, and compare force, events, state");
  command->add_option("--out", options->out, "Folder for loop.csv and loop.svg");
  command->add_flag("--json", options->json, "Print one JSON object instead of the report");
  command->callback([options] { loop(*options); });
}

}  // namespace crumble::app
