// Separating axes (Gottschalk, Lin, Manocha 1996): two convex bodies that do not overlap are told apart along a normal
// of one or along the cross product of an edge of each; of triangles in one plane, along an in-plane normal of an edge.
// All are tried, since each that separates is a proof, and the in-plane ones are the well-conditioned proofs for
// triangles that are nearly in one plane.
#include "geometry/triangle_overlap.hpp"

#include <algorithm>
#include <cmath>

namespace crumble {
namespace {

// Overlap of the two along `axis`, metres, <= 0 for triangles that it separates; infinite for an axis of no length.
double overlap_along(const Vec3& axis, const Corners& a, const Corners& b) {
  const double length = norm(axis);
  if (!(length > 0)) return std::numeric_limits<double>::infinity();
  // from one corner, so that nothing cancels far from the origin
  const double a1 = dot(axis, a[1] - a[0]), a2 = dot(axis, a[2] - a[0]);
  const double b0 = dot(axis, b[0] - a[0]), b1 = dot(axis, b[1] - a[0]), b2 = dot(axis, b[2] - a[0]);
  const double low_a = std::min({0.0, a1, a2}), high_a = std::max({0.0, a1, a2});
  const double low_b = std::min({b0, b1, b2}), high_b = std::max({b0, b1, b2});
  return std::min(high_a - low_b, high_b - low_a) / length;
}

bool lies_in_plane(const Vec3& unit_normal, const Vec3& of_plane, const Corners& triangle, double tolerance) {
  return std::all_of(triangle.begin(), triangle.end(),
                     [&](const Vec3& corner) { return std::abs(dot(unit_normal, corner - of_plane)) <= tolerance; });
}

}  // namespace

bool triangles_overlap(const Corners& a, const Corners& b, double tolerance) {
  const Vec3 normal_a = normalized(cross(a[1] - a[0], a[2] - a[0]));
  const Vec3 normal_b = normalized(cross(b[1] - b[0], b[2] - b[0]));
  const auto separated = [&](const Vec3& axis) { return overlap_along(axis, a, b) <= tolerance; };
  const bool one_plane = lies_in_plane(normal_a, a[0], b, tolerance) && lies_in_plane(normal_b, b[0], a, tolerance);
  if (!one_plane && (separated(normal_a) || separated(normal_b))) return false;
  for (std::size_t i = 0; i < 3; ++i) {
    const Vec3 edge_a = a[(i + 1) % 3] - a[i], edge_b = b[(i + 1) % 3] - b[i];
    if (separated(cross(normal_a, edge_a)) || separated(cross(normal_b, edge_b))) return false;
  }
  if (one_plane) return true;
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3 edge_a = a[(i + 1) % 3] - a[i], edge_b = b[(k + 1) % 3] - b[k];
      const Vec3 axis = cross(edge_a, edge_b);
      if (norm(axis) > 1e-9 * norm(edge_a) * norm(edge_b) && separated(axis)) return false;
    }
  }
  return true;
}

}  // namespace crumble
