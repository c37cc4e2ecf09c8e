// The surface of a simulation that runs, as pictures and files want it.
#pragma once

#include "crumble/fracture/surface.hpp"
#include "crumble/sim/simulation.hpp"
#include "render/mesh_file.hpp"

namespace crumble::app {

/// Shows the state as it is: what a cut has freed is at once where it settles.
class SurfaceCamera {
 public:
  /// `sim` is borrowed and must outlive the camera.
  SurfaceCamera(const Simulation& sim, SurfaceMode mode);

  /// Looks at the present state. To be called as often as a viewer would: the extractor follows what turns from one
  /// look to the next.
  void refresh();
  /// What the last refresh() saw.
  render::Surface surface() const;

 private:
  const Simulation* sim_;
  SurfaceExtractor extractor_;
};

}  // namespace crumble::app
