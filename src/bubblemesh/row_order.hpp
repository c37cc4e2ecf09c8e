// The order in which nodes and tetrahedra are handed out.
#pragma once

#include "bubblemesh/cloud.hpp"
#include "bubblemesh/lattice.hpp"
#include "bubblemesh/square_lattice.hpp"
#include "crumble/base/memory.hpp"

namespace crumble {

/// Sorts the nodes by layer, row and place of the lattice (by where they are now, so nodes off the lattice join
/// the nearest row), and the tetrahedra with them. In the bulk, neighbours in a direction then stand at constant
/// offsets.
void put_in_row_order(const LatticeFrame& frame, Cloud& cloud, Vector<Tetrahedron>& tetrahedra);

/// By their nodes: least node first, then the others ascending but for the last two, whose order carries the
/// orientation.
void sort_tetrahedra(Vector<Tetrahedron>& tetrahedra);

/// Fills in rows, places and lattice_neighbours of a mesh whose nodes are in row order.
void describe_rows(const LatticeFrame& frame, BubbleMesh& body);
void describe_rows(const Vector<Site>& sites, BubbleMesh& body);

}  // namespace crumble
