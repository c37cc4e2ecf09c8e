#include "crumble/tetmesh/quality.hpp"

#include <algorithm>
#include <cmath>

#include "crumble/base/memory.hpp"
#include "crumble/base/transcendental.hpp"

namespace crumble {

namespace {

/// Cosine and sine of the six dihedral angles, each pair times a positive factor.
struct Dihedral {
  double cosine, sine;
  double cotangent() const { return cosine / sine; }
  double degrees() const { return std::atan2(sine, cosine) * 180 / kPi; }  // a report: libm is good enough here
};
std::array<Dihedral, 6> dihedrals(const std::array<Vec3, 4>& p) {
  std::array<Dihedral, 6> angles{};
  for (std::size_t e = 0; e < 6; ++e) {
    // edge ij, and the other two corners k and l of the tetrahedron: angle between the parts of k and l across the edge
    const std::size_t i = kTetEdges[e][0], j = kTetEdges[e][1];
    const std::size_t k = kTetEdges[5 - e][0], l = kTetEdges[5 - e][1];
    const Vec3 along = normalized(p[j] - p[i]);
    const Vec3 u = cross(along, p[k] - p[i]), v = cross(along, p[l] - p[i]);
    angles[e] = {dot(u, v), norm(cross(u, v))};
  }
  return angles;
}

}  // namespace

std::array<double, 6> dihedral_angles(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  std::array<double, 6> angles{};
  std::ranges::transform(dihedrals({a, b, c, d}), angles.begin(), &Dihedral::degrees);
  return angles;
}

namespace {

/// Angles are compared by their cotangents, which fall where angles rise: an arc tangent for each took half the time.
void measure_tetrahedra(const TetMesh& mesh, MeshQuality& q) {
  constexpr double kSliver = 2.747477419454622;  // cotangent of 20 degrees
  Dihedral least{-1, 0}, greatest{1, 0};
  q.volume_length_min = 1;
  for (const auto& [a, b, c, d] : mesh.tetrahedra) {
    const std::array<Vec3, 4> p{mesh.positions[a], mesh.positions[b], mesh.positions[c], mesh.positions[d]};
    const auto angles = dihedrals(p);
    const auto [last, first] = std::ranges::minmax(angles, {}, &Dihedral::cotangent);
    if (first.cotangent() > least.cotangent()) least = first;
    if (last.cotangent() < greatest.cotangent()) greatest = last;
    q.slivers += first.cotangent() > kSliver;
    double squares = 0;
    for (const auto& [i, j] : kTetEdges) squares += squared_norm(p[j] - p[i]);
    const double rms = std::sqrt(squares / 6);
    const double volume_length = std::sqrt(2.0) * orient(p[0], p[1], p[2], p[3]) / (rms * rms * rms);
    q.volume_length_min = std::min(q.volume_length_min, volume_length);
    q.volume_length_mean += volume_length / static_cast<double>(mesh.tetrahedra.size());
  }
  q.dihedral_min = least.degrees();
  q.dihedral_max = greatest.degrees();
}

void measure_edges(const TetMesh& mesh, MeshQuality& q) {
  Vector<double> lengths;
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
