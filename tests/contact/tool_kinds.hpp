// One tool of every kind, a centimetre or two in size.
#pragma once

#include <string>

#include "contact/contact_rig.hpp"
#include "crumble/base/memory.hpp"
#include "crumble/geometry/mesh_solid.hpp"
#include "crumble/geometry/support_solid.hpp"
#include "crumble/geometry/tool_solids.hpp"
#include "geometry/solid_meshes.hpp"

namespace crumble {

struct ToolKind {
  std::string name;
  Tool tool;
  bool convex = true;
};

// The farthest point of an ellipsoid of 8 x 4 x 6 mm along d.
inline void ellipsoid_support(void*, const double d[3], double point[3]) {
  const double axes[3] = {0.004, 0.002, 0.003};
  double squares = 0;
  for (int k = 0; k < 3; ++k) squares += (axes[k] * d[k]) * (axes[k] * d[k]);
  for (int k = 0; k < 3; ++k) point[k] = axes[k] * axes[k] * d[k] / std::sqrt(squares);
}

inline Vector<ToolKind> tool_kinds() {
  const auto tool = [](Solid shape) { return Tool{std::move(shape), kPaperFriction}; };
  TriangleMesh corner = make_l_shape();
  Vec3 low = corner.vertices[0], high = low;
  for (const Vec3& v : corner.vertices) low = low.cwiseMin(v), high = high.cwiseMax(v);
  for (Vec3& v : corner.vertices) v = 0.012 / (high - low).maxCoeff() * (v - 0.5 * (low + high));
  return {{"round_stick", tool(make_round_stick(0.004, 0.02, 16))},
          {"bar", tool(make_bar({0.006, 0.006, 0.02}))},
          {"thin_blade", tool(make_bar({0.001, 0.01, 0.02}))},
          {"bevelled_blade", tool(make_blade({0.002, 0.01, 0.02}, 0.004))},
          {"needle", tool(make_round_stick(0.001, 0.02, 16))},
          {"ball", tool(make_ball(0.004))},
          {"capsule", tool(make_capsule(0.002, 0.015))},
          {"cone", tool(make_cone(0.004, 0.012))},
          {"ellipsoid", tool(make_support_solid({ellipsoid_support, nullptr}, Vec3::Zero()))},
          {"l_shape", tool(make_mesh_solid(corner)), false}};
}

}  // namespace crumble
