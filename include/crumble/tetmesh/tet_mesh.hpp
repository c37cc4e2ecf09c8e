// The tetrahedral mesh of a body at rest: immutable once made.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "crumble/base/memory.hpp"
#include "crumble/base/vec.hpp"
#include "crumble/geometry/triangle_mesh.hpp"

namespace crumble {

using Tetrahedron = std::array<std::uint32_t, 4>;  // node indices; positive volume in this order
using Edge = std::array<std::uint32_t, 2>;         // node indices, first < second

/// Springs of a tetrahedron in the order of its cut mask's bits: 01 02 03 12 13 23 (local corner indices).
inline constexpr std::array<std::array<std::uint8_t, 2>, 6> kTetEdges{{{0, 1}, {0, 2}, {0, 3}, {1, 2}, {1, 3}, {2, 3}}};
/// Corners of the face opposite local corner f, counter-clockwise seen from outside.
inline constexpr std::array<std::array<std::uint8_t, 3>, 4> kTetFaces{{{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}}};

/// Where on the body a node sits.
enum class NodeKind : std::uint8_t { corner = 0, crease = 1, surface = 2, inside = 3 };

struct TetMesh {
  Vector<Vec3> positions;                            // at rest, metres (node_count)
  Vector<NodeKind> kinds;                            // (node_count)
  Vector<double> node_volumes;                       // a quarter of each tetrahedron, m^3 (node_count)
  Vector<Tetrahedron> tetrahedra;                    // (tetrahedron_count)
  Vector<Edge> springs;                              // every edge once, ascending (spring_count)
  Vector<std::array<std::uint32_t, 6>> tet_springs;  // spring ids in kTetEdges order (tetrahedron_count)
  Vector<Triangle> boundary;                         // outward faces with one tetrahedron

  std::size_t node_count() const { return positions.size(); }
  std::size_t surface_node_count() const;
};

/// Derives springs, boundary and volumes from nodes and tetrahedra. `kinds` may be empty: then boundary nodes are
/// `surface` and the others `inside`. Throws Error: empty, invalid_value, mesh (index out of range, flat or inverted
/// tetrahedron, a face with more than two tetrahedra), isolated_node, duplicate_node; names the first bad index.
TetMesh make_tet_mesh(Vector<Vec3> positions, Vector<Tetrahedron> tetrahedra, Vector<NodeKind> kinds = {});

/// Sum of the tetrahedra's volumes, m^3.
double volume(const TetMesh& mesh);

}  // namespace crumble
