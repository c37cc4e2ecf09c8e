// Scenes: a body, tools, and the motions that move them, as JSON. One library of them for tests, benchmarks and apps.
//
// docs/scenes.md is the reference of the format. SI units; angles in degrees.
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "crumble/base/memory.hpp"
#include "crumble/device/open.hpp"
#include "crumble/device/workspace.hpp"
#include "crumble/sim/simulation.hpp"
#include "crumble/tetmesh/quality.hpp"

namespace crumble {

enum class Preset { standard, paper };

/// How a scene moves one of its tools or attachments: by its path if it has one, else by its trajectory, else it
/// presses.
struct Motion {
  Pose start;
  PressOptions press;      // from `start`
  Vector<PathPoint> path;  // from `start`
  std::optional<Trajectory> trajectory;
  WorkspaceOptions workspace;  // from the trajectory's frame to the scene
  ReplayOptions replay;
};

struct Scene {
  std::string name;
  std::string description;
  SimulationDef def;  // one tool at least
  MeshQuality quality;
  Vector<std::string> warnings;  // of the mesh generator
  Vector<Motion> motions;        // of the tools, then of the attachments
  double top = 0;                // y of the highest node at rest, metres: where a tool's depth is 0

  /// Simulated seconds that a tick of a device takes.
  double tick() const { return def.step.tau * def.step.iterations; }
};

/// `name` is a built-in scene or the path of a JSON file. Throws Error: io, format (JSON, unknown key, missing key,
/// wrong type), out_of_range (a size that is not positive, ...) and what the parts refuse; the message names the key by
/// its path. The material is checked where a Simulation is made of it.
Scene load_scene(const std::string& name, Preset preset);

/// A trajectory by built-in name ("press_1mm_s") or path of a .ctraj file.
Trajectory load_trajectory(const std::string& name);

Vector<std::string> scene_names();

/// A device that makes a motion, and how long it does.
struct MotionDevice {
  std::unique_ptr<Device> device;
  Workspace workspace;
  double seconds = 0;
};
MotionDevice open_motion(const Motion& motion, double tick);

}  // namespace crumble
