// How good a mesh is, and whether it is whole.
#pragma once

#include <array>
#include <cstddef>

#include "crumble/tetmesh/tet_mesh.hpp"

namespace crumble {

/// Dihedral angles in degrees, lengths in metres.
struct MeshQuality {
  double dihedral_min = 0, dihedral_max = 0;
  std::size_t slivers = 0;       // tetrahedra with a dihedral angle below 20 degrees
  double volume_length_min = 0;  // 6 sqrt2 V / l_rms^3, 1 for the regular tetrahedron
  double volume_length_mean = 0;
  double edge_min = 0, edge_mean = 0, edge_max = 0;
  double edge_variation = 0;   // standard deviation / mean
  long long euler_defect = 0;  // E - (T + V + Fs/2 - 1): 0 for a ball
  SurfaceDefects boundary_defects;
};
MeshQuality measure_quality(const TetMesh& mesh);

/// The six dihedral angles of a tetrahedron, degrees, in kTetEdges order.
std::array<double, 6> dihedral_angles(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d);

}  // namespace crumble
