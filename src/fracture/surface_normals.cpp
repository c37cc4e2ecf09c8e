#include "surface_normals.hpp"

#include <algorithm>
#include <limits>

namespace crumble {
namespace {

Eigen::Vector3f unit(const Vec3& area_vector) noexcept {
  const double length = std::max(norm(area_vector), std::numeric_limits<double>::min());
  return (1 / length * area_vector).cast<float>();
}

}  // namespace

void SurfaceNormals::update(const TriangleList& triangles, std::span<const Vec3> positions) noexcept {
  shade_skin(triangles, positions);
  shade_interior(triangles, positions);
}

void SurfaceNormals::shade_skin(const TriangleList& triangles, std::span<const Vec3> positions) noexcept {
  const auto slot = [&](std::size_t t, std::size_t corner) {
    const surface_patterns::VertexCode code = triangles.codes()[t][corner];
    const SurfaceTopology::OuterFace& face = topology_.outer_faces[triangles.outer_faces()[t]];
    return face.first_normal_slots[surface_patterns::site_of(code)] + surface_patterns::copy_of(code);
  };
  std::fill(sums_.begin(), sums_.end(), Vec3::Zero());
  for (std::size_t t = 0; t < triangles.skin_count(); ++t) {
    const auto [a, b, c] = triangles.vertices()[t];
    const Vec3 area = cross(positions[b] - positions[a], positions[c] - positions[a]);
    for (std::size_t k = 0; k < 3; ++k) sums_[slot(t, k)] += area;
  }
  for (std::size_t t = 0; t < triangles.skin_count(); ++t) {
    for (std::size_t k = 0; k < 3; ++k) corners_[t][k] = unit(sums_[slot(t, k)]);
  }
}

// The two halves of a facet, (a b c) with the fourth corner d and (c d a), mostly stand side by side.
void SurfaceNormals::shade_interior(const TriangleList& triangles, std::span<const Vec3> positions) noexcept {
  const std::span<const Triangle> vertices = triangles.vertices();
  for (std::size_t t = triangles.skin_count(); t < vertices.size(); ++t) {
    const auto [a, b, c] = vertices[t];
    const std::uint32_t d = triangles.fourth(t);
    corners_[t].fill(unit(cross(positions[c] - positions[a], positions[d] - positions[b])));
    if (t + 1 == vertices.size()) return;
    const auto& next = vertices[t + 1];
    if (next[0] != c || next[1] != d || next[2] != a) continue;
    corners_[t + 1] = corners_[t];
    ++t;
  }
}

}  // namespace crumble
