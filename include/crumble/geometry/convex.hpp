// Convex polyhedra: what the sticks are made of.
#pragma once

#include <cstdint>
#include <limits>

#include "crumble/base/memory.hpp"
#include "crumble/base/vec.hpp"
#include "crumble/geometry/triangle_mesh.hpp"

namespace crumble {

/// n . x <= offset inside; n is a unit vector.
struct Plane {
  Vec3 normal;
  double offset;
};

/// The faces of a polyhedron as the searches below read them: the planes with one array per component, padded to whole
/// kLanes by planes that nothing is above, and the triangles of each plane.
struct FaceTable {
  static constexpr std::size_t kLanes = 4;
  Vector<double> x, y, z, offset;
  Vector<Triangle> triangles;            // in the order of their planes
  Vector<std::uint32_t> first_triangle;  // of each plane, and the end
};

/// A closed convex polyhedron in its own frame, metres. The functions below make it.
struct ConvexPolyhedron {
  Vector<Plane> planes;
  Vector<Vec3> vertices;
  TriangleMesh surface;       // for drawing and for other libraries; same vertices
  double half_thickness = 0;  // radius of the largest sphere about the vertex mean that fits inside
  FaceTable faces;
  double edge_sine = 1;  // see SolidModel::edge_sine()
};

/// Greatest n . x - offset over the planes: negative inside, where its magnitude is the depth under the nearest
/// face; `nearest` receives that plane's index. Outside it is a lower bound of the distance.
double greatest_plane_distance(const ConvexPolyhedron& body, const Vec3& p, std::uint32_t& nearest);

/// Where the surface is nearest to p, and how far: negative inside (under the nearest face), the Euclidean distance
/// outside. A point farther out than `far` is answered with a lower bound that is greater than `far`, and with a point
/// that means nothing.
struct SurfaceQuery {
  Vec3 point;
  double signed_distance;
  std::uint32_t plane;  // the face met; at an edge or corner the one that p is farthest above
};
SurfaceQuery nearest_surface(const ConvexPolyhedron& body, const Vec3& p,
                             double far = std::numeric_limits<double>::infinity());

/// Round stick: a right prism on a regular polygon with `sides` corners on the circle of `radius`, axis +Z through the
/// origin, one face looking down (-Y) when `sides` is even.
ConvexPolyhedron make_round_stick(double radius, double length, std::uint32_t sides);
/// Bar with edges x, y, z about the origin.
ConvexPolyhedron make_bar(const Vec3& size);
/// From a closed triangle mesh. Throws Error: mesh (fewer than 4 triangles or vertices, index, non-finite, degenerate),
/// mesh_open, mesh_orientation, mesh_nonconvex; the message names the first bad index.
ConvexPolyhedron make_convex(const TriangleMesh& mesh);

}  // namespace crumble
