// One experiment: a scene, a device that moves its tool, and all that was measured on the way.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "crumble/device/device.hpp"
#include "crumble/sim/recording.hpp"
#include "runner/clocks.hpp"
#include "scenes/scene.hpp"

namespace crumble::app {

struct Sample {
  double time = 0;   // simulated seconds
  double depth = 0;  // of the tool's lowest point below the body's top at rest, metres; negative above
  Wrench wrench;     // on the tool
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
  std::string device;
  bool resampled = false;
  std::vector<Sample> samples;
  std::vector<Event> events;
  bench::Percentiles cost;  // CPU time of the steps, microseconds; of all threads, divided by those at work
  double peak_force = 0;    // N
};

/// Moves the scene's tool by `device`, "press:MM_PER_S" or "replay:FILE" (empty: what the scene says), until the motion
/// is over or `seconds` have been simulated. The origin of FILE's motion lies where the tool starts. `progress` is told
/// the share done. Throws Error, also when the body diverges.
Experiment run_experiment(Scene scene, const std::string& device, std::optional<double> seconds,
                          const DebrisOptions& debris, const std::function<void(double)>& progress);

double tool_depth(const Scene& scene, const Pose& pose);
/// Without those that were removed.
std::size_t count_fragments(const Simulation& sim);
/// Tetrahedra whose four nodes are inside out now.
std::size_t count_inverted(const Simulation& sim);

}  // namespace crumble::app
