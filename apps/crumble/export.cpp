// `crumble export`: runs a recording again and writes what it holds at one time, or at many, for other programs.
#include <algorithm>
#include <array>
#include <cmath>

#include "capture.hpp"
#include "commands.hpp"
#include "crumble/base/memory.hpp"
#include "grids.hpp"
#include "output.hpp"
#include "render/file_set.hpp"

namespace crumble::app {
namespace {

using std::filesystem::path;

struct ExportOptions {
  std::string recording, out, what = "surface", mode;
  std::optional<double> at, every;
};

struct Stage {
  const Simulation& sim;
  const SurfaceCamera& camera;
};

// What can be exported: its formats for one time, and how one is written.
struct Kind {
  const char* name;
  std::string extensions;
  void (*add)(const Stage& stage, const path& file, render::FileSet& files);
};

void add_surface(const Stage& stage, const path& file, render::FileSet& files) {
  render::add_mesh_file(stage.camera.surface(), file, files);
}

void add_fragments(const Stage& stage, const path& file, render::FileSet& files) {
  const bool is_json = file.extension() == ".json";
  files.add(file, is_json ? fragment_json(stage.sim).dump(1) + '\n' : to_vtu(fragment_grid(stage.sim)));
}

template <render::VtkGrid (*kGrid)(const Simulation&)>
void add_grid(const Stage& stage, const path& file, render::FileSet& files) {
  files.add(file, to_vtu(kGrid(stage.sim)));
}

const Kind& kind_of(const ExportOptions& options) {
  static const std::array<Kind, 4> kinds{{{"surface", render::mesh_file_extensions(), add_surface},
                                          {"springs", ".vtu", add_grid<spring_grid>},
                                          {"body", ".vtu", add_grid<body_grid>},
                                          {"fragments", ".json .vtu", add_fragments}}};
  const auto kind = std::ranges::find(kinds, options.what, &Kind::name);
  if (kind == kinds.end()) {
    throw Error(Code::unsupported,
                "--what '" + options.what + "' is not known; there are: surface springs body fragments");
  }
  require_extension(options.out, kind->extensions + " .pvd");
  if (!options.every && path(options.out).extension() == ".pvd") {
    throw Error(Code::format, "--out '" + options.out + "' holds a series and needs --every");
  }
  return *kind;
}

SurfaceMode mode_of(const ExportOptions& options) {
  constexpr std::array<const char*, 3> kNames{"cracks", "fragments", "paper"};
  if (options.mode.empty()) return SurfaceMode::cracks;
  if (options.what != "surface") throw Error(Code::format, "--mode '" + options.mode + "' is for --what surface");
  const auto name = std::ranges::find(kNames, options.mode);
  if (name == kNames.end()) {
    throw Error(Code::unsupported, "--mode '" + options.mode + "' is not known; there are: cracks fragments paper");
  }
  return static_cast<SurfaceMode>(name - kNames.begin());
}

// The step after which a time is nearest; the state before the first one is not looked at.
std::size_t step_at(double time, double tick) {
  return static_cast<std::size_t>(std::max(std::floor(time / tick + 0.5), 1.0)) - 1;
}

Vector<std::size_t> wanted_steps(const Recording& recording, double tick, const ExportOptions& options) {
  if (recording.step_count() == 0) throw Error(Code::empty, "recording '" + options.recording + "' has no step");
  const double last = static_cast<double>(recording.step_count()) * tick;
  if (options.every) {
    require_in_range("--every", *options.every, tick, last);
  } else {
    require_in_range("--at", *options.at, 0, last);
  }
  Vector<std::size_t> steps;
  const auto count = options.every ? static_cast<std::size_t>(std::floor(last / *options.every + 1e-9)) + 1 : 1;
  for (std::size_t frame = 0; frame < count; ++frame) {
    const double time = options.every ? static_cast<double>(frame) * *options.every : *options.at;
    const std::size_t step = std::min(step_at(time, tick), recording.step_count() - 1);
    if (steps.empty() || steps.back() != step) steps.push_back(step);
  }
  return steps;
}

// Where the frames of a series go: name_0007.ply beside each other, those of name.pvd in a folder `name`.
class Series {
 public:
  Series(path out, render::FileSet& files) : out_(std::move(out)), files_(files) {
    if (is_pvd()) files.make_folder(folder());
  }
  path next(double time) {
    std::string number = std::to_string(frames_.size());
    number.insert(0, number.size() < 4 ? 4 - number.size() : 0, '0');
    path name = out_.stem();
    name += "_" + number;
    name += is_pvd() ? path(".vtu") : out_.extension();
    frames_.emplace_back(time, (out_.stem() / name).generic_string());
    return (is_pvd() ? folder() : out_.parent_path()) / name;
  }
  void finish() {
    if (is_pvd()) files_.add(out_, render::to_pvd(frames_));
  }

 private:
  bool is_pvd() const { return out_.extension() == ".pvd"; }
  path folder() const { return path(out_).replace_extension(); }

  path out_;
  render::FileSet& files_;
  Vector<std::pair<double, std::string>> frames_;
};

void export_recording(const ExportOptions& options) {
  const Kind& kind = kind_of(options);
  const SurfaceMode mode = mode_of(options);
  const Recording recording = Recording::load(options.recording);
  Simulation sim = recording.start();
  const StepSettings& settings = sim.definition().step;
  const auto steps = wanted_steps(recording, settings.tau * settings.iterations, options);
  SurfaceCamera camera(sim, mode);
  render::FileSet files;
  if (options.every) {
    Series series(options.out, files);
    rerun(recording, sim, camera, steps, [&](std::size_t) {
      kind.add({sim, camera}, series.next(sim.info().time), files);
    });
    series.finish();
  } else {
    rerun(recording, sim, camera, steps, [&](std::size_t) { kind.add({sim, camera}, options.out, files); });
  }
  files.commit();
}

}  // namespace

void add_export(CLI::App& app) {
  auto* command = app.add_subcommand("export", "Write what a recording holds at a given time for other programs");
  auto options = std::make_shared<ExportOptions>();
  command->add_option("recording", options->recording, "A file that `run --out` wrote")->required();
  auto* when = command->add_option_group("when")->require_option(1);
  when->add_option("--at", options->at, "Simulated seconds from the recording's start");
  when->add_option("--every", options->every, "Seconds between the frames of a series over the whole recording");
  command->add_option("--out", options->out, "File by extension; .pvd: a series")->required();
  command->add_option("--what", options->what, "surface, springs, body or fragments")->capture_default_str();
  command->add_option("--mode", options->mode, "What a cut opens in the surface: cracks (default), fragments or paper");
  command->callback([options] { export_recording(*options); });
}

}  // namespace crumble::app
