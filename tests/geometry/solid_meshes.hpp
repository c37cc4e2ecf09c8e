// Closed meshes to try solids on.
#pragma once

#include <array>
#include <string>

#include "crumble/base/memory.hpp"
#include "crumble/geometry/triangle_mesh.hpp"

namespace crumble {

/// Right prism along z on a polygon (counter-clockwise) all of whose corners the origin sees.
TriangleMesh make_prism(const Vector<std::array<double, 2>>& polygon, double height);
/// A closed polygon in the half-plane (r, z), counter-clockwise, turned about z in `steps` steps; points with r = 0
/// stay single.
TriangleMesh make_revolved(const Vector<std::array<double, 2>>& profile, std::uint32_t steps);
/// A sphere of 20 * 4^levels triangles whose radius is 1 + `roughness` * noise.
TriangleMesh make_blob(int levels, double roughness, std::uint64_t seed);

TriangleMesh make_l_shape();
TriangleMesh make_torus(double radius, double tube, std::uint32_t steps, std::uint32_t tube_steps);
TriangleMesh make_cup();         // walls of 0.1, radius 1, height 1.5
TriangleMesh make_gear();        // twelve teeth
TriangleMesh make_hollow_box();  // 2 x 2 x 2 with a cavity of 1 x 1 x 1

struct NamedMesh {
  std::string name;
  TriangleMesh mesh;
};
/// One of each, none convex.
Vector<NamedMesh> concave_meshes();

}  // namespace crumble
