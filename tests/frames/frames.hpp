// Watches a scene's whole motion as a viewer would, 60 pictures a second, and counts what an eye would object to:
// holes, flicker, and parts that jump.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>

#include "crumble/base/memory.hpp"
#include "crumble/fracture/surface.hpp"
#include "scenes/scene.hpp"
#include "support/silhouette.hpp"

namespace crumble::frames {

inline constexpr double kFramePeriod = 1.0 / 60;  // s

/// Pictures of one camera in a row: pixels that change and change back at once.
class FlickerCounter {
 public:
  /// Pixels that were covered in the picture before the last, were not in the last and are again, or the other way
  /// round. Where the outline passed within a pixel in either of the outer two, motion explains it and it is not
  /// counted.
  std::size_t add(const Silhouette& picture);

 private:
  Vector<std::uint8_t> before_, last_;  // covered or not
};

/// How far the drawn skin has moved from frame to frame, beyond its nodes.
class PopMeter {
 public:
  explicit PopMeter(const TetMesh& mesh) : mesh_(&mesh) {}

  /// Metres: the way of a vertex of the skin from where the same point of the body was drawn in the frame before (where
  /// it had several copies, from the nearest) to where it is now, less the greatest way of the three nodes of its outer
  /// face. 0 in the first frame.
  struct Pops {
    double opening = 0;  // greatest in outer faces that are in other parts than in the frame before: a crack has opened
    double motion = 0;   // greatest elsewhere
  };
  Pops add(const SurfaceExtractor& surface, VecView nodes);

 private:
  // A part of an outer face as it was drawn.
  struct Part {
    std::array<Vec3, 3> rest, place;
  };
  double way_of(const Vec3& rest, const Vec3& place, const Vector<Part>& parts) const;

  const TetMesh* mesh_;
  Vector<Vector<Part>> parts_;  // per triangle of the boundary, in the frame before
  Vector<Vec3> nodes_;          // in the frame before
};

struct Worst {
  double value = 0;
  double time = 0;  // s
  void see(double candidate, double when) {
    if (candidate > value) value = candidate, time = when;
  }
};

struct Report {
  std::size_t frames = 0, cuts = 0;
  std::size_t defects = 0;      // of the surface's connections, over all frames looked at; mode `paper`: open edges
  std::size_t hole_pixels = 0;  // over all pictures
  Worst backs;                  // share of a picture's covered pixels where one looks into the surface
  Worst sound_backs;            // the same while no tetrahedron is inside out
  Worst flicker;                // pixels of a picture
  Worst opening, motion;        // PopMeter::Pops, in mean rest lengths of a spring
};

struct Options {
  SurfaceSettings surface = {};
  int size = 256;               // pixels of a picture, both ways
  std::size_t check_every = 5;  // frames between two looks at the connections; the last frame is always looked at
};

/// Moves the scene's tool as the scene says and draws the body from three directions. Throws Error(diverged).
Report watch(const Scene& scene, const Options& options);

/// Which bounds of the modes `cracks` and `paper` a report breaks, in words; empty: none. How they were found is in
/// frames.cpp. (In the mode `fragments` a piece that comes free shows all cracks round it at once.)
std::string complaint(const Report& report);

}  // namespace crumble::frames
