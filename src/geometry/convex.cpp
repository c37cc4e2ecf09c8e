#include "crumble/geometry/convex.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <string>

#include "crumble/base/error.hpp"
#include "crumble/base/memory.hpp"
#include "crumble/base/text.hpp"
#include "crumble/base/transcendental.hpp"

namespace crumble {
namespace {

std::string triangle_name(std::size_t t) {
  return "tool triangle " + std::to_string(t);
}

void check_vertices(const TriangleMesh& mesh) {
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v) {
    if (!is_finite(mesh.vertices[v])) throw Error(Code::mesh, "tool vertex " + std::to_string(v) + " is not finite");
  }
}

void check_triangles(const TriangleMesh& mesh, double size) {
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    for (const std::uint32_t v : mesh.triangles[t]) {
      if (v >= mesh.vertices.size()) {
        throw Error(Code::mesh, triangle_name(t) + " names vertex " + std::to_string(v) + " of " +
                                    std::to_string(mesh.vertices.size()));
      }
    }
    const auto& [a, b, c] = mesh.triangles[t];
    const Vec3 n = cross(mesh.vertices[b] - mesh.vertices[a], mesh.vertices[c] - mesh.vertices[a]);
    if (norm(n) < 1e-12 * size * size) throw Error(Code::mesh, triangle_name(t) + " is degenerate: its area is zero");
  }
}

double extent(const TriangleMesh& mesh) {
  Vec3 low = mesh.vertices[0], high = mesh.vertices[0];
  for (const Vec3& v : mesh.vertices) low = low.cwiseMin(v), high = high.cwiseMax(v);
  return norm(high - low);
}

void check_closed(const TriangleMesh& mesh) {
  const SurfaceDefects defects = find_surface_defects(mesh);
  if (defects.open_edges + defects.nonmanifold_edges > 0) {
    throw Error(Code::mesh_open, "tool mesh is not closed: " + std::to_string(defects.open_edges) + " open and " +
                                     std::to_string(defects.nonmanifold_edges) + " non-manifold edges");
  }
  if (defects.flipped_edges > 0) {
    throw Error(Code::mesh_orientation,
                "tool mesh is not consistently oriented: " + std::to_string(defects.flipped_edges) + " flipped edges");
  }
  if (volume(mesh) <= 0) throw Error(Code::mesh_orientation, "tool mesh faces inward: its volume is negative");
}

// One plane per flat face: triangles of the same plane share it; `plane_of` receives that of each triangle.
Vector<Plane> face_planes(const TriangleMesh& mesh, double size, Vector<std::size_t>& plane_of) {
  Vector<Plane> planes;
  for (const auto& [a, b, c] : mesh.triangles) {
    const Vec3 n = normalized(cross(mesh.vertices[b] - mesh.vertices[a], mesh.vertices[c] - mesh.vertices[a]));
    const Plane plane{n, dot(n, mesh.vertices[a])};
    const auto known = std::find_if(planes.begin(), planes.end(), [&](const Plane& p) {
      return norm(p.normal - plane.normal) < 1e-9 && std::abs(p.offset - plane.offset) < 1e-9 * size;
    });
    plane_of.push_back(static_cast<std::size_t>(known - planes.begin()));
    if (known == planes.end()) planes.push_back(plane);
  }
  return planes;
}

FaceTable face_table(const Vector<Plane>& planes, const TriangleMesh& mesh, const Vector<std::size_t>& plane_of) {
  FaceTable table;
  for (std::size_t i = 0; i < planes.size(); ++i) {
    table.x.push_back(planes[i].normal.x());
    table.y.push_back(planes[i].normal.y());
    table.z.push_back(planes[i].normal.z());
    table.offset.push_back(planes[i].offset);
    table.first_triangle.push_back(static_cast<std::uint32_t>(table.triangles.size()));
    for (std::size_t t = 0; t < plane_of.size(); ++t) {
      if (plane_of[t] == i) table.triangles.push_back(mesh.triangles[t]);
    }
  }
  table.first_triangle.push_back(static_cast<std::uint32_t>(table.triangles.size()));
  const std::size_t padded = (planes.size() + FaceTable::kLanes - 1) / FaceTable::kLanes * FaceTable::kLanes;
  table.x.resize(padded), table.y.resize(padded), table.z.resize(padded);
  table.offset.resize(padded, std::numeric_limits<double>::infinity());
  return table;
}

void check_convex(const ConvexPolyhedron& body, double size) {
  for (std::size_t p = 0; p < body.planes.size(); ++p) {
    for (std::size_t v = 0; v < body.vertices.size(); ++v) {
      const double above = dot(body.planes[p].normal, body.vertices[v]) - body.planes[p].offset;
      if (above > 1e-9 * size) {
        throw Error(Code::mesh_nonconvex, "tool mesh is not convex: vertex " + std::to_string(v) + " lies " +
                                              to_text(above) + " m above face " + std::to_string(p));
      }
    }
  }
}

double inscribed_radius(const ConvexPolyhedron& body) {
  Vec3 center = Vec3::Zero();
  for (const Vec3& v : body.vertices) center += v;
  center /= static_cast<double>(body.vertices.size());
  std::uint32_t nearest = 0;
  return -greatest_plane_distance(body, center, nearest);
}

// In a vertex the ball that fits best rolls along the axis whose greatest angle with the normals round it is least: the
// center of the smallest cap that holds them (Badoiu and Clarkson 2003: toward the farthest one, by ever less). An edge
// ends in vertices that are as sharp or sharper.
double sharpest_sine(const ConvexPolyhedron& body, const Vector<std::size_t>& plane_of) {
  constexpr int kTurns = 200;
  Vector<Vector<std::size_t>> planes_at(body.vertices.size());
  for (std::size_t t = 0; t < plane_of.size(); ++t) {
    for (const std::uint32_t v : body.surface.triangles[t]) planes_at[v].push_back(plane_of[t]);
  }
  double sharpest = 1;
  for (const Vector<std::size_t>& planes : planes_at) {
    if (planes.empty()) continue;
    Vec3 center = body.planes[planes[0]].normal;
    double sine = 0;
    for (int turn = 2; turn <= kTurns; ++turn) {
      const auto along = [&](std::size_t plane) { return dot(body.planes[plane].normal, center); };
      std::size_t farthest = planes[0];
      for (const std::size_t plane : planes) {
        if (along(plane) < along(farthest)) farthest = plane;
      }
      const double length = norm(center);
      if (length > 0) sine = std::max(sine, along(farthest) / length);
      center += (body.planes[farthest].normal - center) / turn;
    }
    sharpest = std::min(sharpest, sine);
  }
  return sharpest;
}

}  // namespace

// Four lanes as two vectors of GCC's and Clang's own kind: the loop over plain arrays they turn into jumps, one for
// each plane. Each lane keeps the first of its greatest, and of the lanes that share the greatest of all the one with
// the least index wins: what one loop over the planes would find, on every processor.
double greatest_plane_distance(const ConvexPolyhedron& body, const Vec3& p, std::uint32_t& nearest) {
  using Pair = double __attribute__((vector_size(16)));
  using Indexes = std::int64_t __attribute__((vector_size(16)));
  static_assert(FaceTable::kLanes == 4);
  const FaceTable& f = body.faces;
  const double px = p.x(), py = p.y(), pz = p.z();
  const auto pair = [](const Vector<double>& from, std::size_t i) {
    Pair to;
    std::memcpy(&to, from.data() + i, sizeof to);
    return to;
  };
  const auto distance = [&](std::size_t i) {
    return ((pair(f.x, i) * px + pair(f.y, i) * py) + pair(f.z, i) * pz) - pair(f.offset, i);
  };
  Pair greatest[2] = {distance(0), distance(2)};
  Indexes plane[2] = {{0, 1}, {2, 3}}, here[2] = {{0, 1}, {2, 3}};
  for (std::size_t i = 4; i < f.x.size(); i += 4) {
    for (std::size_t k = 0; k < 2; ++k) {
      const Pair d = distance(i + 2 * k);
      const Indexes more = d > greatest[k];
      here[k] += 4;
      greatest[k] = more ? d : greatest[k];
      plane[k] = more ? here[k] : plane[k];
    }
  }
  double best = greatest[0][0];
  std::int64_t first = plane[0][0];
  for (std::size_t lane = 1; lane < 4; ++lane) {
    const double d = greatest[lane / 2][lane % 2];
    const std::int64_t i = plane[lane / 2][lane % 2];
    if (d > best || (d == best && i < first)) best = d, first = i;
  }
  nearest = static_cast<std::uint32_t>(first);
  return best;
}

// The nearest point of a convex body lies on a face that p is above: p - q is a sum of normals of the faces at q with
// factors >= 0, so not all of these faces can have p below them.
SurfaceQuery nearest_surface(const ConvexPolyhedron& body, const Vec3& p, double far) {
  SurfaceQuery query{};
  query.signed_distance = greatest_plane_distance(body, p, query.plane);
  query.point = p - query.signed_distance * body.planes[query.plane].normal;
  if (query.signed_distance <= 0 || query.signed_distance > far) return query;
  const FaceTable& f = body.faces;
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < body.planes.size(); ++i) {
    if (dot(body.planes[i].normal, p) - body.planes[i].offset <= 0) continue;
    for (std::uint32_t t = f.first_triangle[i]; t < f.first_triangle[i + 1]; ++t) {
      const auto& [a, b, c] = f.triangles[t];
      const Vec3 q = closest_on_triangle(p, body.vertices[a], body.vertices[b], body.vertices[c]);
      const double squared = squared_norm(p - q);
      if (squared < least) least = squared, query.point = q;
    }
  }
  query.signed_distance = std::sqrt(least);
  return query;
}

ConvexPolyhedron make_convex(const TriangleMesh& mesh) {
  if (mesh.triangles.size() < 4 || mesh.vertices.size() < 4) {
    throw Error(Code::mesh,
                "tool mesh has " + std::to_string(mesh.triangles.size()) + " triangles, at least 4 are needed");
  }
  check_vertices(mesh);
  const double size = extent(mesh);
  check_triangles(mesh, size);
  check_closed(mesh);
  Vector<std::size_t> plane_of;
  ConvexPolyhedron body{face_planes(mesh, size, plane_of), mesh.vertices, mesh, 0, {}};
  body.faces = face_table(body.planes, mesh, plane_of);
  check_convex(body, size);
  body.half_thickness = inscribed_radius(body);
  body.edge_sine = sharpest_sine(body, plane_of);
  return body;
}

ConvexPolyhedron make_round_stick(double radius, double length, std::uint32_t sides) {
  require_positive("radius", radius);
  require_positive("length", length);
  require_in_range("sides", sides, 3, 4096);
  TriangleMesh mesh;
  for (std::uint32_t i = 0; i < sides; ++i) {
    // the middle of a side looks down
    const double angle = 2 * kPi * (i + 0.5) / sides - kPi / 2;
    const Vec3 rim(radius * cos_exact(angle), radius * sin_exact(angle), 0.5 * length);
    mesh.vertices.push_back(rim);
    mesh.vertices.push_back({rim.x(), rim.y(), -rim.z()});
  }
  for (std::uint32_t i = 0; i < sides; ++i) {
    const std::uint32_t front = 2 * i, back = front + 1, next_front = 2 * ((i + 1) % sides), next_back = next_front + 1;
    mesh.triangles.push_back({front, back, next_back});
    mesh.triangles.push_back({front, next_back, next_front});
    if (i > 0 && i + 1 < sides) {
      mesh.triangles.push_back({0, front, next_front});
      mesh.triangles.push_back({1, next_back, back});
    }
  }
  return make_convex(mesh);
}

ConvexPolyhedron make_bar(const Vec3& size) {
  require_positive("size.x", size.x());
  require_positive("size.y", size.y());
  require_positive("size.z", size.z());
  TriangleMesh mesh;
  for (int i = 0; i < 8; ++i) {
    mesh.vertices.push_back(
        0.5 * Vec3(i & 1 ? size.x() : -size.x(), i & 2 ? size.y() : -size.y(), i & 4 ? size.z() : -size.z()));
  }
  mesh.triangles = {{0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}, {0, 1, 5}, {0, 5, 4},
                    {2, 6, 7}, {2, 7, 3}, {0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}};
  return make_convex(mesh);
}

}  // namespace crumble
