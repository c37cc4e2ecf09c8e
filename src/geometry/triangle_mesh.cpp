#include "crumble/geometry/triangle_mesh.hpp"

#include <algorithm>
#include <map>

#include "crumble/base/memory.hpp"

namespace crumble {
namespace {

// Number of fans that the triangles around one vertex form; `spokes` maps each outgoing to its incoming neighbour.
std::size_t count_fans(const Vector<std::array<std::uint32_t, 2>>& spokes) {
  Vector<std::size_t> parent(spokes.size());
  for (std::size_t i = 0; i < parent.size(); ++i) parent[i] = i;
  const auto root = [&](std::size_t i) {
    while (parent[i] != i) i = parent[i] = parent[parent[i]];
    return i;
  };
  std::map<std::uint32_t, std::size_t> seen;
  for (std::size_t i = 0; i < spokes.size(); ++i) {
    for (const std::uint32_t neighbour : spokes[i]) {
      const auto [at, is_new] = seen.emplace(neighbour, i);
      if (!is_new) parent[root(i)] = root(at->second);
    }
  }
  std::size_t fans = 0;
  for (std::size_t i = 0; i < parent.size(); ++i) fans += root(i) == i;
  return fans;
}

}  // namespace

TrianglePoint nearest_on_triangle(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c) {
  const Vec3 ab = b - a, ac = c - a;
  const double d1 = dot(ab, p - a), d2 = dot(ac, p - a);
  if (d1 <= 0 && d2 <= 0) return {a, TriangleFeature::a};
  const double d3 = dot(ab, p - b), d4 = dot(ac, p - b);
  if (d3 >= 0 && d4 <= d3) return {b, TriangleFeature::b};
  const double d5 = dot(ab, p - c), d6 = dot(ac, p - c);
  if (d6 >= 0 && d5 <= d6) return {c, TriangleFeature::c};
  const double vc = d1 * d4 - d3 * d2;
  if (vc <= 0 && d1 >= 0 && d3 <= 0) return {a + d1 / (d1 - d3) * ab, TriangleFeature::ab};
  const double vb = d5 * d2 - d1 * d6;
  if (vb <= 0 && d2 >= 0 && d6 <= 0) return {a + d2 / (d2 - d6) * ac, TriangleFeature::ca};
  const double va = d3 * d6 - d5 * d4;
  if (va <= 0 && d4 - d3 >= 0 && d5 - d6 >= 0) {
    return {b + (d4 - d3) / ((d4 - d3) + (d5 - d6)) * (c - b), TriangleFeature::bc};
  }
  return {a + vb / (va + vb + vc) * ab + vc / (va + vb + vc) * ac, TriangleFeature::face};
}

Vec3 closest_on_triangle(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c) {
  return nearest_on_triangle(p, a, b, c).point;
}

double volume(const TriangleMesh& mesh) {
  double sum = 0;
  for (const auto& [a, b, c] : mesh.triangles) sum += dot(mesh.vertices[a], cross(mesh.vertices[b], mesh.vertices[c]));
  return sum / 6;
}

double area(const TriangleMesh& mesh) {
  double sum = 0;
  for (const auto& [a, b, c] : mesh.triangles) {
    sum += norm(cross(mesh.vertices[b] - mesh.vertices[a], mesh.vertices[c] - mesh.vertices[a]));
  }
  return sum / 2;
}

SurfaceDefects find_surface_defects(const TriangleMesh& mesh) {
  SurfaceDefects defects;
  std::map<Triangle::value_type, Vector<std::array<std::uint32_t, 2>>> spokes;
  std::map<std::array<std::uint32_t, 2>, std::array<int, 2>> uses;  // undirected edge -> {along, against}
  for (const Triangle& t : mesh.triangles) {
    if (t[0] == t[1] || t[1] == t[2] || t[2] == t[0]) ++defects.degenerate_triangles;
    for (int k = 0; k < 3; ++k) {
      const std::uint32_t a = t[k], b = t[(k + 1) % 3], c = t[(k + 2) % 3];
      ++uses[{std::min(a, b), std::max(a, b)}][a < b ? 0 : 1];
      spokes[a].push_back({b, c});
    }
  }
  for (const auto& [edge, count] : uses) {
    const int total = count[0] + count[1];
    if (total == 1) ++defects.open_edges;
    if (total > 2) ++defects.nonmanifold_edges;
    if (total == 2 && count[0] != 1) ++defects.flipped_edges;
  }
  for (const auto& [vertex, around] : spokes) {
    if (count_fans(around) > 1) ++defects.split_vertices;
  }
  return defects;
}

}  // namespace crumble
