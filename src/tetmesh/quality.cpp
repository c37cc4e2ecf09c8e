#include "crumble/tetmesh/quality.hpp"

#include <algorithm>
#include <cmath>

#include "crumble/base/transcendental.hpp"

namespace crumble {

std::array<double, 6> dihedral_angles(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  const std::array<Vec3, 4> p{a, b, c, d};
  std::array<double, 6> angles{};
  for (std::size_t e = 0; e < 6; ++e) {
    // edge ij, and the other two corners k and l of the tetrahedron: angle between the parts of k and l across the edge
    const std::size_t i = kTetEdges[e][0], j = kTetEdges[e][1];
    const std::size_t k = kTetEdges[5 - e][0], l = kTetEdges[5 - e][1];
    const Vec3 along = normalized(p[j] - p[i]);
    const Vec3 u = cross(along, p[k] - p[i]), v = cross(along, p[l] - p[i]);
    // a report, not a decision: libm's atan2 is good enough here
    angles[e] = std::atan2(norm(cross(u, v)), dot(u, v)) * 180 / kPi;
  }
  return angles;
}

namespace {

void measure_tetrahedra(const TetMesh& mesh, MeshQuality& q) {
  q.dihedral_min = 180;
  q.volume_length_min = 1;
  for (const auto& [a, b, c, d] : mesh.tetrahedra) {
    const std::array<Vec3, 4> p{mesh.positions[a], mesh.positions[b], mesh.positions[c], mesh.positions[d]};
    const auto angles = dihedral_angles(p[0], p[1], p[2], p[3]);
    const auto [least, greatest] = std::minmax_element(angles.begin(), angles.end());
    q.dihedral_min = std::min(q.dihedral_min, *least);
    q.dihedral_max = std::max(q.dihedral_max, *greatest);
    q.slivers += *least < 20;
    double squares = 0;
    for (const auto& [i, j] : kTetEdges) squares += squared_norm(p[j] - p[i]);
    const double rms = std::sqrt(squares / 6);
    const double volume_length = std::sqrt(2.0) * orient(p[0], p[1], p[2], p[3]) / (rms * rms * rms);
    q.volume_length_min = std::min(q.volume_length_min, volume_length);
    q.volume_length_mean += volume_length / static_cast<double>(mesh.tetrahedra.size());
  }
}

void measure_edges(const TetMesh& mesh, MeshQuality& q) {
  std::vector<double> lengths;
  for (const auto& [i, j] : mesh.springs) lengths.push_back(norm(mesh.positions[j] - mesh.positions[i]));
  const auto n = static_cast<double>(lengths.size());
  for (const double l : lengths) q.edge_mean += l / n;
  double variance = 0;
  for (const double l : lengths) variance += (l - q.edge_mean) * (l - q.edge_mean) / n;
  q.edge_variation = std::sqrt(variance) / q.edge_mean;
  q.edge_min = *std::min_element(lengths.begin(), lengths.end());
  q.edge_max = *std::max_element(lengths.begin(), lengths.end());
}

}  // namespace

MeshQuality measure_quality(const TetMesh& mesh) {
  MeshQuality q;
  measure_tetrahedra(mesh, q);
  measure_edges(mesh, q);
  const auto count = [](const auto& list) { return static_cast<long long>(list.size()); };
  q.euler_defect =
      count(mesh.springs) - (count(mesh.tetrahedra) + count(mesh.positions) + count(mesh.boundary) / 2 - 1);
  q.boundary_defects = find_surface_defects({mesh.positions, mesh.boundary});
  return q;
}

}  // namespace crumble
