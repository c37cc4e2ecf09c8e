// The second pass over an experiment: runs its recording again, which proves that it repeats bit for bit, keeps the
// energy ledger, and takes the surface at chosen steps.
#pragma once

#include <functional>

#include "crumble/base/memory.hpp"
#include "experiment.hpp"
#include "render/scene.hpp"
#include "surface_camera.hpp"

namespace crumble::app {

struct Capture {
  std::size_t step = 0;
  Vector<Pose> tools;
  render::Surface body;  // closed, vertices shared
};

struct Rerun {
  EnergyLedger ledger;
  Vector<Capture> captures;
};

/// `how`: kernel and threads. `steps`: after which to take the surface, from 0, ascending; one capture each, also when
/// a step stands there twice. Throws Error(diverged) when a state hash differs from the recording's.
Rerun rerun(const Recording& recording, StepSettings how, const Vector<std::size_t>& steps);

/// Runs the recording again on `sim`, which is at its start, and calls `take` with each of `steps` (from 0, ascending;
/// twice for one that stands there twice) when that step has been done and `camera`, which looks at `sim`, has seen it.
/// Throws Error(diverged) when a state hash differs from the recording's.
void rerun(const Recording& recording, Simulation& sim, SurfaceCamera& camera, const Vector<std::size_t>& steps,
           const std::function<void(std::size_t)>& take);

/// Of a press the four phases of the paper's Fig 11: at rest, first touch, half way, deepest. Else the beginning, two
/// thirds between, and the end.
Vector<std::size_t> phase_steps(const Experiment& experiment);

/// A tool as it is drawn.
render::RenderMesh tool_mesh(const Tool& tool, const Pose& hand);

}  // namespace crumble::app
