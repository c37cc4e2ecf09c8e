// One experiment: a scene, devices that move its tools, and all that was measured on the way.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "crumble/base/memory.hpp"
#include "crumble/device/device.hpp"
#include "crumble/sim/recording.hpp"
#include "live_changes.hpp"
#include "runner/clocks.hpp"
#include "scenes/scene.hpp"

namespace crumble::app {

struct ToolSample {
  double depth = 0;  // of the tool's lowest point below the body's top at rest, metres; negative above
  Wrench wrench;     // on the tool
};

struct Sample {
  double time = 0;  // simulated seconds
  Vector<ToolSample> tools;
  std::uint64_t cuts = 0;
};

/// What to do with small fragments at rest, 60 times a second.
struct DebrisOptions {
  DebrisRule rule{0};  // none
  FragmentState fate = FragmentState::asleep;
};

struct Experiment {
  Experiment(Scene scene_given, Simulation sim_given)
      : scene(std::move(scene_given)), sim(std::move(sim_given)), recording(sim) {}

  Scene scene;
  Simulation sim;
  Recording recording;
  std::string device;  // of each tool and attachment, for people
  bool resampled = false;
  Vector<Sample> samples;
  Vector<Event> events;
  bench::Percentiles cost;     // CPU time of the steps, microseconds; of all threads, divided by those at work
  Vector<double> peak_forces;  // on each tool, N
};

/// Moves what the scene moves, its first tool by `device`, "press:MM_PER_S" or "replay:FILE" (empty: what the scene
/// says), until all motions are over or `seconds` have been simulated, and makes `changes` on the way. The origin of
/// FILE's motion lies where the tool starts. `progress` is told the share done. Throws Error, also when the body
/// diverges.
Experiment run_experiment(Scene scene, const std::string& device, std::optional<double> seconds,
                          const DebrisOptions& debris, LiveChanges changes,
                          const std::function<void(double)>& progress);

/// Whether one tool goes straight down, or up and down by hand, so that its depth tells how far things have come.
bool is_press(const Scene& scene);
/// "the tool" when there is but one, else "tool 1" and so on.
std::string tool_name(const Scene& scene, std::size_t tool);
/// Without those that were removed.
std::size_t count_fragments(const Simulation& sim);
/// Tetrahedra whose four nodes are inside out now.
std::size_t count_inverted(const Simulation& sim);

}  // namespace crumble::app
