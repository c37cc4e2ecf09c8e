#include "geometry/mesh_checks.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "crumble/base/error.hpp"
#include "crumble/base/memory.hpp"
#include "crumble/base/text.hpp"
#include "geometry/triangle_overlap.hpp"
#include "geometry/triangle_tree.hpp"
#include "geometry/winding_number.hpp"

namespace crumble {
namespace {

constexpr double kLeastSize = 1e-6;     // metres
constexpr double kTouching = 1e-10;     // of the size: surfaces that overlap by less than this touch
constexpr double kNextTo = 1e-11;       // of the size: nearer to a surface than any other may be
constexpr double kFlat = 1e-9;          // volume over area times size of what counts as flat
constexpr std::size_t kMaxParts = 256;  // each is judged by a winding number, which visits all triangles
constexpr std::uint32_t kNone = ~std::uint32_t{0};

std::string triangle_name(std::size_t t) {
  return "tool triangle " + std::to_string(t);
}

void check_numbers(const TriangleMesh& mesh) {
  if (mesh.triangles.empty()) throw Error(Code::empty, "tool mesh has no triangles");
  if (mesh.triangles.size() < 4) {
    throw Error(Code::mesh,
                "tool mesh has " + std::to_string(mesh.triangles.size()) + " triangles, at least 4 are needed");
  }
  if (mesh.triangles.size() > kMaxSolidTriangles) {
    throw Error(Code::too_large, "tool mesh has " + std::to_string(mesh.triangles.size()) + " triangles, at most " +
                                     std::to_string(kMaxSolidTriangles) + " are allowed");
  }
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    for (const std::uint32_t v : mesh.triangles[t]) {
      if (v < mesh.vertices.size()) continue;
      throw Error(Code::mesh, triangle_name(t) + " names vertex " + std::to_string(v) + " of " +
                                  std::to_string(mesh.vertices.size()));
    }
  }
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v) {
    const Vec3& p = mesh.vertices[v];
    if (!is_finite(p)) throw Error(Code::mesh, "tool vertex " + std::to_string(v) + " is not finite");
    for (int axis = 0; axis < 3; ++axis) {
      if (std::abs(p[axis]) <= kMaxSolidCoordinate) continue;
      throw Error(Code::out_of_range, "tool vertex " + std::to_string(v) + " has the coordinate " + to_text(p[axis]) +
                                          " m, at most " + to_text(kMaxSolidCoordinate) + " is allowed");
    }
  }
}

// Diagonal of the box of the vertices that triangles use.
double size_of(const TriangleMesh& mesh) {
  Vec3 low = mesh.vertices[mesh.triangles[0][0]], high = low;
  for (const Triangle& t : mesh.triangles) {
    for (const std::uint32_t v : t) low = low.cwiseMin(mesh.vertices[v]), high = high.cwiseMax(mesh.vertices[v]);
  }
  const double size = norm(high - low);
  if (size < kLeastSize) {
    throw Error(Code::out_of_range, "tool mesh is " + to_text(size) + " m across, at least 1e-6 is needed");
  }
  return size;
}

// The triangles that have an area, and which of the caller's each was. Vertices keep their order: a solid that was
// turned inside out is written and read back with the same numbers.
TriangleMesh without_degenerate(const TriangleMesh& mesh, double size, Vector<std::size_t>& origin) {
  TriangleMesh kept;
  Vector<std::uint32_t> new_number(mesh.vertices.size(), kNone);
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const auto& [a, b, c] = mesh.triangles[t];
    const Vec3 doubled = cross(mesh.vertices[b] - mesh.vertices[a], mesh.vertices[c] - mesh.vertices[a]);
    if (norm(doubled) < 1e-12 * size * size) continue;
    for (const std::uint32_t v : mesh.triangles[t]) new_number[v] = 0;
    kept.triangles.push_back(mesh.triangles[t]);
    origin.push_back(t);
  }
  for (std::size_t v = 0; v < new_number.size(); ++v) {
    if (new_number[v] == kNone) continue;
    new_number[v] = static_cast<std::uint32_t>(kept.vertices.size());
    kept.vertices.push_back(mesh.vertices[v]);
  }
  for (Triangle& triangle : kept.triangles) {
    for (std::uint32_t& v : triangle) v = new_number[v];
  }
  return kept;
}

struct Edge {
  std::uint32_t low, high;  // vertices
  std::uint32_t id;         // 3 t + k
  bool operator<(const Edge& other) const {
    return low != other.low ? low < other.low : high != other.high ? high < other.high : id < other.id;
  }
};

// The other side of each edge; in a closed, oriented mesh it runs the other way.
Vector<std::uint32_t> pair_edges(const TriangleMesh& mesh, const Vector<std::size_t>& origin, bool dropped) {
  Vector<Edge> edges;
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    for (std::uint32_t k = 0; k < 3; ++k) {
      const std::uint32_t from = mesh.triangles[t][k], to = mesh.triangles[t][(k + 1) % 3];
      edges.push_back({std::min(from, to), std::max(from, to), 3 * t + k});
    }
  }
  std::sort(edges.begin(), edges.end());
  Vector<std::uint32_t> opposite(edges.size(), kNone);
  std::uint32_t open = kNone, crowded = kNone, flipped = kNone;
  for (std::size_t first = 0, end = 0; first < edges.size(); first = end) {
    while (end < edges.size() && edges[end].low == edges[first].low && edges[end].high == edges[first].high) ++end;
    const std::uint32_t id = edges[first].id;
    if (end - first == 1) open = std::min(open, id);
    if (end - first > 2) crowded = std::min(crowded, id);
    if (end - first != 2) continue;
    const std::uint32_t other = edges[first + 1].id;
    if (mesh.triangles[id / 3][id % 3] == mesh.triangles[other / 3][other % 3]) flipped = std::min(flipped, id);
    opposite[id] = other, opposite[other] = id;
  }
  const auto name = [&](std::uint32_t id) {
    return triangle_name(origin[id / 3]) + ", edge " + std::to_string(id % 3);
  };
  if (open != kNone) {
    throw Error(Code::mesh_open, "tool mesh is open: " + name(open) + ", has no triangle on its other side" +
                                     (dropped ? " once the triangles without area are left out" : ""));
  }
  if (crowded != kNone) throw Error(Code::mesh, "tool mesh: " + name(crowded) + ", joins more than two triangles");
  if (flipped != kNone) {
    throw Error(Code::mesh_orientation,
                "tool mesh: " + name(flipped) + ", runs the same way in both of its triangles: one is flipped");
  }
  return opposite;
}

// Around a vertex all triangles can be reached over edges.
void check_fans(const CheckedMesh& checked, const Vector<std::size_t>& origin) {
  const auto& triangles = checked.mesh.triangles;
  Vector<std::uint32_t> corners(checked.mesh.vertices.size(), 0), start(checked.mesh.vertices.size(), kNone);
  for (std::uint32_t t = 0; t < triangles.size(); ++t) {
    for (std::uint32_t k = 0; k < 3; ++k) {
      ++corners[triangles[t][k]];
      if (start[triangles[t][k]] == kNone) start[triangles[t][k]] = 3 * t + k;
    }
  }
  for (const std::uint32_t first : start) {
    std::uint32_t reached = 0, edge = first;  // edges that leave the vertex
    do {
      const std::uint32_t back = checked.opposite[edge];  // it arrives there; the next edge of that triangle leaves
      edge = back / 3 * 3 + (back % 3 + 1) % 3;
      ++reached;
    } while (edge != first);
    const std::uint32_t vertex = triangles[first / 3][first % 3];
    if (reached == corners[vertex]) continue;
    throw Error(Code::mesh, "tool mesh: corner " + std::to_string(first % 3) + " of " +
                                triangle_name(origin[first / 3]) + " joins surfaces that share no edge there");
  }
}

double squared_area(const TriangleMesh& mesh, std::uint32_t t) {
  const auto& [a, b, c] = mesh.triangles[t];
  return squared_norm(cross(mesh.vertices[b] - mesh.vertices[a], mesh.vertices[c] - mesh.vertices[a]));
}

// Greatest triangle of each connected part.
Vector<std::uint32_t> find_parts(const CheckedMesh& checked) {
  Vector<std::uint32_t> parts, open;
  Vector<bool> seen(checked.mesh.triangles.size());
  for (std::uint32_t first = 0; first < seen.size(); ++first) {
    if (seen[first]) continue;
    std::uint32_t greatest = first;
    seen[first] = true;
    open = {first};
    while (!open.empty()) {
      const std::uint32_t t = open.back();
      open.pop_back();
      if (squared_area(checked.mesh, t) > squared_area(checked.mesh, greatest)) greatest = t;
      for (std::uint32_t k = 0; k < 3; ++k) {
        const std::uint32_t neighbour = checked.opposite[3 * t + k] / 3;
        if (seen[neighbour]) continue;
        seen[neighbour] = true;
        open.push_back(neighbour);
      }
    }
    parts.push_back(greatest);
  }
  if (parts.size() > kMaxParts) {
    throw Error(Code::too_large, "tool mesh has " + std::to_string(parts.size()) + " parts, at most " +
                                     std::to_string(kMaxParts) + " are allowed");
  }
  return parts;
}

void check_crossings(const TriangleMesh& mesh, const Vector<std::size_t>& origin, double size) {
  const TriangleTree tree(mesh);
  const auto corners = [&](std::uint32_t t) {
    const auto& [a, b, c] = mesh.triangles[t];
    return Corners{mesh.vertices[a], mesh.vertices[b], mesh.vertices[c]};
  };
  Vector<std::uint32_t> near;
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    tree.find_later_neighbours(mesh.triangles[t], t, mesh, near);
    const Corners here = corners(t);
    for (const std::uint32_t other : near) {
      if (!triangles_overlap(here, corners(other), kTouching * size)) continue;
      throw Error(Code::mesh, triangle_name(origin[t]) + " and triangle " + std::to_string(origin[other]) +
                                  " of the tool mesh run through each other");
    }
  }
}

// Before each part the surface goes round nothing; behind it, once more than before it.
void check_parts(const CheckedMesh& checked, const Vector<std::size_t>& origin) {
  for (const std::uint32_t t : checked.parts) {
    const auto& [ia, ib, ic] = checked.mesh.triangles[t];
    const Vec3 &a = checked.mesh.vertices[ia], &b = checked.mesh.vertices[ib], &c = checked.mesh.vertices[ic];
    const Vec3 step = kNextTo * checked.size * normalized(cross(b - a, c - a));
    const double before = std::round(winding_number(checked.mesh, (a + b + c) / 3 + step));
    const std::string part = "tool mesh: the part with " + triangle_name(origin[t]);
    if (before < 0) throw Error(Code::mesh_orientation, part + " is inside out");
    if (before > 0) {
      throw Error(Code::mesh, part + " lies in the inside of another and is not turned to be a cavity of it");
    }
  }
}

}  // namespace

CheckedMesh check_solid_mesh(const TriangleMesh& mesh, const MeshSolidOptions& options, MeshSolidReport& report) {
  check_numbers(mesh);
  CheckedMesh checked;
  checked.size = size_of(mesh);
  Vector<std::size_t> origin;
  checked.mesh = without_degenerate(mesh, checked.size, origin);
  report.dropped_triangles = mesh.triangles.size() - checked.mesh.triangles.size();
  if (checked.mesh.triangles.size() < 4) throw Error(Code::mesh, "tool mesh has fewer than 4 triangles with an area");
  checked.size = size_of(checked.mesh);
  checked.opposite = pair_edges(checked.mesh, origin, report.dropped_triangles > 0);
  check_fans(checked, origin);
  checked.parts = find_parts(checked);
  const double enclosed = volume(checked.mesh);
  if (std::abs(enclosed) <= kFlat * area(checked.mesh) * checked.size) {
    throw Error(Code::mesh, "tool mesh is flat: it encloses " + to_text(enclosed) + " m^3");
  }
  if (enclosed < 0) {
    if (!options.auto_orient) {
      throw Error(Code::mesh_orientation,
                  "tool mesh faces inward: it encloses " + to_text(enclosed) + " m^3; auto_orient would turn it");
    }
    for (Triangle& t : checked.mesh.triangles) std::swap(t[1], t[2]);
    checked.opposite = pair_edges(checked.mesh, origin, false);
    report.flipped = true;
  }
  check_crossings(checked.mesh, origin, checked.size);
  check_parts(checked, origin);
  return checked;
}

bool is_locally_convex(const CheckedMesh& checked) {
  if (checked.parts.size() != 1) return false;
  const TriangleMesh& mesh = checked.mesh;
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    const auto& [a, b, c] = mesh.triangles[t];
    const Vec3& origin = mesh.vertices[a];
    const Vec3 normal = normalized(cross(mesh.vertices[b] - origin, mesh.vertices[c] - origin));
    for (std::uint32_t k = 0; k < 3; ++k) {
      const std::uint32_t edge = checked.opposite[3 * t + k];
      const Vec3& apex = mesh.vertices[mesh.triangles[edge / 3][(edge % 3 + 2) % 3]];
      if (dot(normal, apex - origin) > 1e-9 * checked.size) return false;
    }
  }
  return true;
}

}  // namespace crumble
