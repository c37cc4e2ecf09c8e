// All triangles, and the winding number by the C library: what the mesh solids are compared with.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include "crumble/geometry/triangle_mesh.hpp"

namespace crumble::brute_force {

inline double distance_to_segment(const Vec3& p, const Vec3& a, const Vec3& b) {
  const double s = std::clamp((p - a).dot(b - a) / (b - a).squaredNorm(), 0.0, 1.0);
  return (p - (a + s * (b - a))).norm();
}

/// Height over the triangle where the foot lies on it, else the least distance of its edges.
inline double distance_to_triangle(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c) {
  const Vec3 n = (b - a).cross(c - a);
  const double u = n.dot((b - a).cross(p - a)), v = n.dot((c - b).cross(p - b)), w = n.dot((a - c).cross(p - c));
  if (u >= 0 && v >= 0 && w >= 0) return std::abs(n.dot(p - a)) / n.norm();
  return std::min({distance_to_segment(p, a, b), distance_to_segment(p, b, c), distance_to_segment(p, c, a)});
}

inline double distance(const TriangleMesh& mesh, const Vec3& p) {
  double least = std::numeric_limits<double>::infinity();
  for (const auto& [a, b, c] : mesh.triangles) {
    least = std::min(least, distance_to_triangle(p, mesh.vertices[a], mesh.vertices[b], mesh.vertices[c]));
  }
  return least;
}

inline double winding(const TriangleMesh& mesh, const Vec3& p) {
  double sum = 0;
  for (const auto& [ia, ib, ic] : mesh.triangles) {
    const Vec3 a = mesh.vertices[ia] - p, b = mesh.vertices[ib] - p, c = mesh.vertices[ic] - p;
    const double la = a.norm(), lb = b.norm(), lc = c.norm();
    sum += std::atan2(a.dot(b.cross(c)), la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb);
  }
  return sum / (2 * M_PI);
}

inline bool is_inside(const TriangleMesh& mesh, const Vec3& p) {
  return std::round(winding(mesh, p)) == 1;
}

/// Least way along the ray at which a triangle is passed from behind; infinite when there is none.
inline double first_exit(const TriangleMesh& mesh, const Vec3& p, const Vec3& direction) {
  double least = std::numeric_limits<double>::infinity();
  for (const auto& [a, b, c] : mesh.triangles) {
    const Vec3 &va = mesh.vertices[a], ab = mesh.vertices[b] - va, ac = mesh.vertices[c] - va;
    const Vec3 h = direction.cross(ac);  // Moeller and Trumbore
    const double det = ab.dot(h);
    if (det >= 0) continue;  // from before
    const double u = (p - va).dot(h) / det;
    const Vec3 q = (p - va).cross(ab);
    const double v = direction.dot(q) / det, way = ac.dot(q) / det;
    if (u >= 0 && v >= 0 && u + v <= 1 && way >= 0) least = std::min(least, way);
  }
  return least;
}

}  // namespace crumble::brute_force
