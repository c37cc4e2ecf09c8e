// Triangles in space.
#pragma once

#include <array>
#include <cstdint>

#include "crumble/base/memory.hpp"
#include "crumble/base/vec.hpp"

namespace crumble {

using Triangle = std::array<std::uint32_t, 3>;  // vertex indices, counter-clockwise seen from outside

struct TriangleMesh {
  Vector<Vec3> vertices;  // metres
  Vector<Triangle> triangles;
};

/// What of a triangle a b c a point lies on.
enum class TriangleFeature : std::uint8_t { a = 0, b = 1, c = 2, ab = 3, bc = 4, ca = 5, face = 6 };
struct TrianglePoint {
  Vec3 point;
  TriangleFeature feature;
};
/// Nearest point of the triangle a b c to p (Ericson, Real-Time Collision Detection, 5.1.5).
TrianglePoint nearest_on_triangle(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c);
Vec3 closest_on_triangle(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c);

/// Enclosed volume by the divergence theorem, m^3; negative when the triangles face inward.
double volume(const TriangleMesh& mesh);
/// m^2.
double area(const TriangleMesh& mesh);

/// What keeps a surface from being closed, oriented and 2-manifold; all zero when it is.
struct SurfaceDefects {
  std::size_t open_edges = 0;            // used by one triangle
  std::size_t nonmanifold_edges = 0;     // used by more than two
  std::size_t flipped_edges = 0;         // used twice in the same direction
  std::size_t split_vertices = 0;        // whose triangles form more than one fan
  std::size_t degenerate_triangles = 0;  // with a repeated index
  std::size_t total() const {
    return open_edges + nonmanifold_edges + flipped_edges + split_vertices + degenerate_triangles;
  }
};
SurfaceDefects find_surface_defects(const TriangleMesh& mesh);

}  // namespace crumble
