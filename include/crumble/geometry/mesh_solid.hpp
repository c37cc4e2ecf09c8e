// Closed triangle meshes of any form as solids.
#pragma once

#include "crumble/geometry/solid.hpp"

namespace crumble {

struct MeshSolidOptions {
  bool auto_orient = false;  // a mesh that faces inward as a whole is turned inside out instead of refused
};

/// What make_mesh_solid() found and did.
struct MeshSolidReport {
  std::size_t dropped_triangles = 0;  // degenerate ones, without which the mesh is closed as well
  bool flipped = false;               // by auto_orient
  bool polyhedron = false;            // convex, and so made by make_convex()
  std::size_t grid_cells = 0;         // of the mesh kind
  double seconds = 0;                 // that the making took
};

/// More triangles are refused.
inline constexpr std::size_t kMaxSolidTriangles = 2'000'000;
/// Vertices farther from the origin along an axis are refused, metres.
inline constexpr double kMaxSolidCoordinate = 1e3;
/// A convex mesh with more triangles than this stays a mesh: its tree is faster than that many planes.
inline constexpr std::size_t kMaxPolyhedronTriangles = 2000;

/// A closed surface, convex or not, in one part or several, with cavities or without: a polyhedron if it is convex,
/// else a mesh that is asked for its exact nearest triangle. Half the thickness of the mesh kind is half of what 95 %
/// of its surface has behind it, straight inward to the next way out, at 1000 places spread evenly over the area, and
/// at least a thousandth of the longest edge of its box: a wall counts, the sharp rim of a blade does not. Throws Error
/// naming the first triangle, vertex or part at fault: empty; mesh (fewer than 4 triangles, index, not finite, flat, an
/// edge with more than two triangles, a vertex that joins surfaces, surfaces that cross, a part that lies in the inside
/// of another); mesh_open (also when only degenerate triangles close it); mesh_orientation; too_large (triangles,
/// parts); out_of_range (coordinates, size).
Solid make_mesh_solid(const TriangleMesh& mesh, const MeshSolidOptions& options = {},
                      MeshSolidReport* report = nullptr);

}  // namespace crumble
