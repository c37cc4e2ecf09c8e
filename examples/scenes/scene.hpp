// Scenes: a body, a tool, and the motion that moves it, as JSON. One library of them for tests, benchmarks and apps.
//
// docs/scenes.md is the reference of the format. SI units; angles in degrees.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "crumble/device/open.hpp"
#include "crumble/device/workspace.hpp"
#include "crumble/sim/simulation.hpp"
#include "crumble/tetmesh/quality.hpp"

namespace crumble {

enum class Preset { standard, paper };

struct Scene {
  std::string name;
  std::string description;
  SimulationDef def;  // one tool
  MeshQuality quality;
  std::vector<std::string> warnings;  // of the mesh generator
  Pose start;                         // of the tool
  PressOptions press;                 // from `start`; the device where the scene names no trajectory
  std::optional<Trajectory> trajectory;
  WorkspaceOptions workspace;  // from the trajectory's frame to the scene
  ReplayOptions replay;
  double top = 0;  // y of the highest node at rest, metres: where the tool's depth is 0
};

/// `name` is a built-in scene or the path of a JSON file. Throws Error: io, format (JSON, unknown key, missing key,
/// wrong type), out_of_range (a size that is not positive, ...) and what the parts refuse; the message names the key by
/// its path. The material is checked where a Simulation is made of it.
Scene load_scene(const std::string& name, Preset preset);

/// A trajectory by built-in name ("press_1mm_s") or path of a .ctraj file.
Trajectory load_trajectory(const std::string& name);

std::vector<std::string> scene_names();

}  // namespace crumble
