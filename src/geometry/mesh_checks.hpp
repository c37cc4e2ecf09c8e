// What a triangle mesh must be before it can be a solid.
#pragma once

#include "crumble/base/memory.hpp"
#include "crumble/geometry/mesh_solid.hpp"

namespace crumble {

/// A mesh that may be a solid, and what was worked out on the way.
struct CheckedMesh {
  TriangleMesh mesh;               // without degenerate triangles and without vertices that no triangle uses
  Vector<std::uint32_t> opposite;  // of each edge 3 t + k, from corner k of t to the next: the edge on its other side
  Vector<std::uint32_t> parts;     // greatest triangle of each connected part
  double size = 0;                 // diagonal of its box, metres
};

/// Throws what make_mesh_solid() throws.
CheckedMesh check_solid_mesh(const TriangleMesh& mesh, const MeshSolidOptions& options, MeshSolidReport& report);

/// Whether no vertex next to a triangle lies above it: false proves that the mesh is not convex.
bool is_locally_convex(const CheckedMesh& checked);

}  // namespace crumble
