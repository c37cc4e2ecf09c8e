// The bodies that are measured: boxes of about as many springs as one asks for, pressed from above by a round stick.
#pragma once

#include <cstdint>
#include <string>

#include "crumble/base/memory.hpp"
#include "crumble/sim/definition.hpp"

namespace crumble::bench {

/// What a body can be made of:
///   lattice   the undistorted close-packed lattice
///   default   the mesh generator's, relaxed towards the surface; below 6000 springs the paper's own cube
///   shuffled  the default body with nodes and tetrahedra in random order, as a user's mesh may come
Vector<std::string> structure_names();

inline constexpr std::size_t kLeastSprings = 1000, kMostSprings = 5'000'000;

/// What presses:
///   paper   the paper's stick of 8 mm, as long as the body needs
///   scaled  one that grows with the body, and so does the number of nodes that it holds
Vector<std::string> stick_names();

/// The paper's cube enlarged with the spacing kept: each spring and node is the paper's, there are only more.
struct BenchBody {
  std::string structure;
  std::string lattice;             // name of the stacking
  std::size_t wanted_springs = 0;  // what was asked for; the body has about as many
  std::string stick;               // one of stick_names()
  double scale = 1;                // of the body against the paper's
  double stick_scale = 1;          // of stick, depth and speed
  double height = 0;               // metres
  SimulationDef def;               // one tool; step settings at their defaults
  TetMesh ordered;                 // the mesh in lattice row order; the same as def.mesh unless shuffled
  Vector<std::uint32_t> places;    // node of def.mesh for each of `ordered` (node_count)
};

/// Throws Error: unsupported (structure), out_of_range (springs).
BenchBody make_body(std::size_t springs, const std::string& structure, const std::string& stick);

}  // namespace crumble::bench
