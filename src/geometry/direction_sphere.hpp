// Directions spread over the sphere.
#pragma once

#include <array>

#include "crumble/base/memory.hpp"
#include "crumble/geometry/triangle_mesh.hpp"

namespace crumble {

/// The icosahedron, each of its triangles halved along its edges `levels` times: 10 * 4^levels + 2 unit vectors and
/// the triangles between them, seen from outside.
TriangleMesh make_direction_sphere(int levels);

/// For each vertex those that share an edge with it, ascending.
Vector<Vector<std::uint32_t>> neighbours_of(const TriangleMesh& mesh);

}  // namespace crumble
