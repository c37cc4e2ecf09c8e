// The second pass over an experiment: runs its recording again, which proves that it repeats bit for bit, keeps the
// energy ledger, and takes the surface at chosen steps.
#pragma once

#include <vector>

#include "experiment.hpp"
#include "render/scene.hpp"

namespace crumble::app {

struct Capture {
  std::size_t step = 0;
  double time = 0;
  Pose tool;
  render::RenderMesh body;  // the closed surface, vertices shared
};

struct Rerun {
  EnergyLedger ledger;
  std::vector<Capture> captures;
};

/// `how`: kernel and threads. `steps`: after which to take the surface, from 0, ascending; one capture each, also when
/// a step stands there twice. Throws Error(diverged) when a state hash differs from the recording's.
Rerun rerun(const Recording& recording, StepSettings how, const std::vector<std::size_t>& steps);

/// The four phases of the paper's Fig 11: at rest, first touch, half way, deepest.
std::vector<std::size_t> phase_steps(const std::vector<Sample>& samples);

/// A tool as it is drawn.
render::RenderMesh tool_mesh(const ConvexPolyhedron& shape, const Pose& pose);

}  // namespace crumble::app
