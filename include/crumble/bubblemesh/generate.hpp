// The close-packed bubble mesh: tetrahedra of nearly equal size in a body, from a packing of equal balls.
//
// A. Shimada and D. Gossard's bubble mesh (1995), started from a close-packed crystal as the paper does in §2.2: carve
// the body out of the crystal, draw the balls near the surface onto it, let balls push each other to equal distances,
// join them by Delaunay tetrahedra, mend the few bad ones. docs/mesh.md shows the results.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "crumble/base/memory.hpp"
#include "crumble/geometry/shape.hpp"
#include "crumble/tetmesh/quality.hpp"
#include "crumble/tetmesh/tet_mesh.hpp"

namespace crumble {

/// Stacking of the hexagonal layers, which lie level (normal +Y): ABAB or ABCABC.
enum class Lattice : std::uint8_t { hcp, fcc };

enum class Structure : std::uint8_t {
  relaxed,  // bubbles move to equal distances near the surface; deeper than 3.5 spacings they stay on the lattice
  lattice,  // all springs but a few at the surface join neighbours of a face-centred cubic lattice: what the solver is
            // fastest with. Square layers lie level; the lattice is stretched to fit flat faces
};

struct BubbleMeshOptions {
  double spacing = 0;              // distance wanted between neighbouring nodes = ball diameter d, metres, [1e-9, 1e9]
  Vec3 offset = Vec3::Zero();      // of a lattice point from the centre of the bounding box, in units of d, within 1000
  Lattice lattice = Lattice::hcp;  // of the relaxed structure
  Structure structure = Structure::relaxed;
  /// Exact numbers of nodes on the surface (corners and creases included) and inside: both or none. Each must lie
  /// within 0.6 to 1.5 times the number that comes out by itself. Of the relaxed structure only.
  std::optional<std::uint32_t> surface_nodes, inside_nodes;
};

/// Nodes [first, first + count) stand in one row of the lattice, or are nearest to it.
struct LatticeRow {
  std::int32_t layer = 0, row = 0;
  std::uint32_t first = 0, count = 0;
};

struct BubbleMesh {
  TetMesh mesh;                 // nodes in lattice row order: by layer, row, place in the row; tetrahedra by least node
  Vector<LatticeRow> rows;      // all nodes, in their order
  Vector<std::int32_t> places;  // of each node in its row; the nearest if it is off the lattice
  Vector<std::uint8_t> lattice_neighbours;  // per spring: 1 if it joins neighbours on the lattice, see below
  MeshQuality quality;
  double volume_error = 0;  // (volume of the tetrahedra - volume of the shape) / volume of the shape
  Vector<std::string> warnings;
};

// Lattice neighbours are the twelve nearest ones and the two at the far end of the diagonal along which all perfect
// octahedra are cut. That diagonal has no part along the rows. In the relaxed structure both nodes have to stand on the
// lattice exactly; in the lattice structure their sites count, also where nodes are drawn onto the surface.

/// Share of the springs (i, i + o) that stand in runs: the same o for at least `least` consecutive i.
double share_in_runs(const TetMesh& mesh, std::size_t least);

/// The greatest spacing that generate() takes for a shape, metres.
double largest_spacing(const Shape& shape, Structure structure = Structure::relaxed);

/// Meshes a shape. The same bits on every compiler, level of optimisation and number of threads. Throws Error:
/// invalid_value, unsupported or out_of_range (an option), too_coarse (spacing > largest_spacing), too_large (more than
/// 5 million nodes expected; found before memory is taken), mesh (no valid mesh came out).
BubbleMesh generate(const Shape& shape, const BubbleMeshOptions& options);

}  // namespace crumble
