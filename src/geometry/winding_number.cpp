#include "geometry/winding_number.hpp"

#include "geometry/angle.hpp"

namespace crumble {

// Solid angle of a triangle: Van Oosterom and Strackee, 1983.
double winding_number(const TriangleMesh& mesh, const Vec3& p) {
  double sum = 0;
  for (const auto& [ia, ib, ic] : mesh.triangles) {
    const Vec3 a = mesh.vertices[ia] - p, b = mesh.vertices[ib] - p, c = mesh.vertices[ic] - p;
    const double la = norm(a), lb = norm(b), lc = norm(c);
    const double below = ((la * lb * lc + dot(a, b) * lc) + dot(b, c) * la) + dot(c, a) * lb;
    sum += angle_of(below, dot(a, cross(b, c)));
  }
  return sum / (2 * kPi);
}

}  // namespace crumble
