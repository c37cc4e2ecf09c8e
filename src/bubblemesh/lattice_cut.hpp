// Cutting a body out of the square lattice.
#pragma once

#include "bubblemesh/cloud.hpp"
#include "bubblemesh/lattice_body.hpp"
#include "crumble/base/memory.hpp"

namespace crumble {

struct LatticeCut {
  Cloud cloud;  // nodes in row order
  Vector<Site> sites;
  Vector<Tetrahedron> tetrahedra;
};
LatticeCut cut_lattice(const LatticeBody& body, double spacing);

}  // namespace crumble
