#include "bubblemesh/repair.hpp"

#include <algorithm>

#include "crumble/base/memory.hpp"

namespace crumble {
namespace {

/// Boundary faces that touch a surface node. The others are not looked at: deep inside, no tetrahedron is ever dropped.
Vector<Triangle> boundary_near_surface(const Cloud& cloud, const Vector<Tetrahedron>& tetrahedra) {
  const auto on_surface = [&](std::uint32_t v) { return cloud.kinds[v] != NodeKind::inside; };
  Vector<Triangle> faces;
  for (const Tetrahedron& t : tetrahedra) {
    for (const auto& f : kTetFaces) {
      Triangle face{t[f[0]], t[f[1]], t[f[2]]};
      if (!std::ranges::any_of(face, on_surface)) continue;
      std::ranges::sort(face);
      faces.push_back(face);
    }
  }
  std::ranges::sort(faces);
  Vector<Triangle> single;
  for (std::size_t i = 0; i < faces.size();) {
    std::size_t end = i + 1;
    while (end < faces.size() && faces[end] == faces[i]) ++end;
    if (end == i + 1) single.push_back(faces[i]);
    i = end;
  }
  return single;
}

template <class T>
void sort_unique(Vector<T>& values) {
  std::ranges::sort(values);
  values.erase(std::unique(values.begin(), values.end()), values.end());
}

}  // namespace

Flaws find_flaws(const Cloud& cloud, const Vector<CreaseEdge>& crease_edges, const Vector<Tetrahedron>& tetrahedra) {
  Flaws flaws;
  Vector<Edge> edges;
  for (const Triangle& face : boundary_near_surface(cloud, tetrahedra)) {
    edges.insert(edges.end(), {{face[0], face[1]}, {face[0], face[2]}, {face[1], face[2]}});
    for (const std::uint32_t v : face) {
      if (cloud.kinds[v] == NodeKind::inside) flaws.exposed.push_back(v);
    }
  }
  sort_unique(edges);
  sort_unique(flaws.exposed);
  for (const CreaseEdge& piece : crease_edges) {
    if (!std::ranges::binary_search(edges, piece.nodes)) flaws.broken_creases.push_back(piece.crease);
  }
  sort_unique(flaws.broken_creases);
  return flaws;
}

void bring_to_surface(const Shape& shape, const Vector<std::uint32_t>& nodes, Cloud& cloud) {
  Vector<char> keep(cloud.size(), 1);
  Vector<SurfacePoint> places;
  for (const std::uint32_t node : nodes) {
    keep[node] = 0;
    places.push_back(shape.project(cloud.positions[node]));
  }
  cloud.select(keep);
  Cloud result;
  for (std::size_t i = 0; i < cloud.surface_count; ++i)
    result.add(cloud.positions[i], cloud.kinds[i], cloud.normals[i]);
  for (const SurfacePoint& place : places) result.add(place.point, NodeKind::surface, place.normal);
  for (std::size_t i = cloud.surface_count; i < cloud.size(); ++i) result.add(cloud.positions[i], NodeKind::inside);
  cloud = std::move(result);
}

}  // namespace crumble
