// The face-centred cubic lattice seen along a cube edge: level layers of square grids, each layer shifted by half a
// square against the next, rows along +X.
//
// The same crystal as LatticeFrame's ABCABC, turned so that boxes fit: their level faces are layers, and their upright
// faces lie between two families of nodes a half square apart. Twelve nearest neighbours: four in the layer, four in
// each layer next to it. The holes between nodes are tetrahedra (an edge along x over an edge along z) and octahedra
// (a square with the nodes above and below its middle), one octahedron and two tetrahedra for every node.
#pragma once

#include <array>
#include <cstdint>

#include "crumble/base/vec.hpp"

namespace crumble {

struct Site {
  std::int32_t layer = 0, row = 0, place = 0;
  bool operator==(const Site&) const = default;
};

inline std::int32_t parity(std::int32_t layer) {
  return layer & 1;
}

struct SquareLattice {
  Vec3 origin = Vec3::Zero();  // of site (0, 0, 0), metres
  Vec3 steps = Vec3::Zero();   // between places, layers and rows, metres; perfect: d, d / sqrt 2, d

  Vec3 point(const Site& s) const {
    const double half = 0.5 * parity(s.layer);
    return {origin.x() + steps.x() * (s.place + half), origin.y() + steps.y() * s.layer,
            origin.z() + steps.z() * (s.row + half)};
  }
};

/// The sites half a square away in the next layer above or below (step = 1 or -1).
inline std::array<Site, 4> neighbours_in_layer(const Site& s, std::int32_t step) {
  const std::int32_t layer = s.layer + step, row = s.row + parity(s.layer), place = s.place + parity(s.layer);
  return {{{layer, row - 1, place - 1}, {layer, row - 1, place}, {layer, row, place}, {layer, row, place - 1}}};
}

inline std::array<Site, 12> nearest_neighbours(const Site& s) {
  const auto below = neighbours_in_layer(s, -1), above = neighbours_in_layer(s, 1);
  return {{below[0],
           below[1],
           below[2],
           below[3],
           {s.layer, s.row - 1, s.place},
           {s.layer, s.row, s.place - 1},
           {s.layer, s.row, s.place + 1},
           {s.layer, s.row + 1, s.place},
           above[0],
           above[1],
           above[2],
           above[3]}};
}

/// Nearest neighbours, or the two ends of an octahedron's upright diagonal, along which all perfect octahedra are cut.
inline bool are_lattice_neighbours(const Site& a, const Site& b) {
  const std::int32_t layers = b.layer - a.layer, rows = b.row - a.row, places = b.place - a.place;
  if (layers == 0) return rows * rows + places * places == 1;
  if (layers == 2 || layers == -2) return rows == 0 && places == 0;
  if (layers != 1 && layers != -1) return false;
  const std::int32_t shift = parity(a.layer);
  return (rows == shift || rows == shift - 1) && (places == shift || places == shift - 1);
}

}  // namespace crumble
