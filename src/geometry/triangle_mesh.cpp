#include "crumble/geometry/triangle_mesh.hpp"

#include <algorithm>
#include <map>

namespace crumble {
namespace {

// Number of fans that the triangles around one vertex form; `spokes` maps each outgoing to its incoming neighbour.
std::size_t count_fans(const std::vector<std::array<std::uint32_t, 2>>& spokes) {
  std::vector<std::size_t> parent(spokes.size());
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
  std::map<Triangle::value_type, std::vector<std::array<std::uint32_t, 2>>> spokes;
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
