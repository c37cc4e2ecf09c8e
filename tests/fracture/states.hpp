// Small bodies, cut states and independent counts for the tests of this module.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <numeric>

#include "crumble/base/memory.hpp"
#include "crumble/base/random.hpp"
#include "crumble/base/transcendental.hpp"
#include "crumble/fracture/fragments.hpp"
#include "crumble/fracture/surface.hpp"
#include "crumble/tetmesh/lattice_box.hpp"
#include "crumble/tetmesh/tet_mesh.hpp"

namespace crumble::fracture_test {

using Flags = Vector<std::uint8_t>;  // 1 intact

/// Nodes renumbered: node i becomes order[i].
inline TetMesh make_renumbered(const Vector<Vec3>& positions, const Vector<Tetrahedron>& tetrahedra,
                               const Vector<std::uint32_t>& order) {
  Vector<Vec3> moved(positions.size());
  for (std::size_t i = 0; i < positions.size(); ++i) moved[order[i]] = positions[i];
  Vector<Tetrahedron> renamed = tetrahedra;
  for (Tetrahedron& tetrahedron : renamed) {
    for (std::uint32_t& node : tetrahedron) node = order[node];
  }
  return make_tet_mesh(moved, renamed);
}

inline Vector<std::uint32_t> random_order(std::size_t count, Random& random) {
  Vector<std::uint32_t> order(count);
  std::iota(order.begin(), order.end(), 0u);
  for (std::size_t i = count; i > 1; --i) std::swap(order[i - 1], order[random.below(i)]);
  return order;
}

inline const Vector<Vec3>& two_tetrahedra_points() {
  static const Vector<Vec3> points{{0, 0, 0}, {1, 0.1, 0}, {0.2, 1, 0.1}, {0.3, 0.4, 0.9}, {0.5, 0.3, -0.8}};
  return points;
}

/// `count` tetrahedra round the edge 0-1, closed; ring nodes from 2 on, at `radius` and height 0.
inline TetMesh make_ring(std::uint32_t count, double radius, double height, const Vector<std::uint32_t>& order) {
  Vector<Vec3> points{{0, 0, -height}, {0, 0, height}};
  Vector<Tetrahedron> tetrahedra;
  for (std::uint32_t k = 0; k < count; ++k) {
    const double angle = 2 * kPi * k / count;
    points.push_back({radius * cos_exact(angle), radius * sin_exact(angle), 0});
    tetrahedra.push_back({0, 1, 2 + k, 2 + (k + 1) % count});
    if (orient(points[0], points[1], {1, 0, 0}, {0, 1, 0}) < 0) std::swap(tetrahedra.back()[0], tetrahedra.back()[1]);
  }
  return make_renumbered(points, tetrahedra, order);
}

inline Flags random_flags(std::size_t count, double cut_share, Random& random) {
  Flags intact(count);
  for (std::uint8_t& flag : intact) flag = random.uniform() >= cut_share;
  return intact;
}

/// Component of each node by flooding, numbered by first node met: independent of the library's union-find.
inline Vector<std::uint32_t> flood_labels(const TetMesh& mesh, const Flags& intact) {
  constexpr std::uint32_t kNone = 0xffffffffu;
  Vector<Vector<std::uint32_t>> neighbors(mesh.node_count());
  for (std::size_t s = 0; s < mesh.springs.size(); ++s) {
    const auto [a, b] = mesh.springs[s];
    if (intact[s] != 0) neighbors[a].push_back(b), neighbors[b].push_back(a);
  }
  Vector<std::uint32_t> labels(mesh.node_count(), kNone);
  std::uint32_t count = 0;
  for (std::uint32_t start = 0; start < mesh.node_count(); ++start) {
    if (labels[start] != kNone) continue;
    Vector<std::uint32_t> open{start};
    labels[start] = count;
    while (!open.empty()) {
      const std::uint32_t node = open.back();
      open.pop_back();
      for (const std::uint32_t other : neighbors[node]) {
        if (labels[other] != kNone) continue;
        labels[other] = count;
        open.push_back(other);
      }
    }
    ++count;
  }
  return labels;
}

inline std::size_t label_count(const Vector<std::uint32_t>& labels) {
  return *std::max_element(labels.begin(), labels.end()) + 1u;
}

/// A body at one moment.
struct Body {
  explicit Body(const TetMesh& of) : mesh(&of), positions(of.positions), intact(of.springs.size(), 1) { relabel(); }
  Body(const TetMesh& of, Flags flags) : Body(of) {
    intact = std::move(flags);
    relabel();
  }
  void relabel() { labels = flood_labels(*mesh, intact); }
  /// Ids by a fragment's least node, so that a split leaves the others' alone.
  void label_by_least_node() {
    relabel();
    std::map<std::uint32_t, std::uint32_t> least;
    for (std::uint32_t i = 0; i < labels.size(); ++i) labels[i] = least.try_emplace(labels[i], i).first->second;
  }
  SurfaceInput now() const { return {positions, intact, labels, time}; }

  const TetMesh* mesh;
  VecArray positions;
  Flags intact;
  Vector<std::uint32_t> labels;
  double time = 0;
};

/// The surface with its vertices at rest, or where they are now.
inline TriangleMesh rest_surface(const SurfaceExtractor& surface) {
  return {{surface.rest_positions().begin(), surface.rest_positions().end()},
          {surface.triangles().begin(), surface.triangles().end()}};
}
inline TriangleMesh current_surface(const SurfaceExtractor& surface) {
  return {{surface.positions().begin(), surface.positions().end()},
          {surface.triangles().begin(), surface.triangles().end()}};
}

/// Volume inside each connected shell of a closed surface.
inline Vector<double> shell_volumes(const TriangleMesh& surface) {
  Vector<std::uint32_t> parents(surface.vertices.size());
  std::iota(parents.begin(), parents.end(), 0u);
  const auto root = [&](std::uint32_t v) {
    while (parents[v] != v) v = parents[v] = parents[parents[v]];
    return v;
  };
  for (const auto& [a, b, c] : surface.triangles) parents[root(a)] = root(b), parents[root(b)] = root(c);
  std::map<std::uint32_t, double> volumes;
  for (const auto& [a, b, c] : surface.triangles) {
    volumes[root(a)] += dot(surface.vertices[a], cross(surface.vertices[b], surface.vertices[c])) / 6;
  }
  Vector<double> result;
  for (const auto& [shell, shell_volume] : volumes) result.push_back(shell_volume);
  return result;
}

/// Solid pieces: every piece has one outer shell, which encloses something; shells of cavities (cracks that lie inside)
/// enclose nothing or a negative volume.
inline std::size_t solid_piece_count(const TriangleMesh& surface, double body_volume) {
  std::size_t count = 0;
  for (const double shell_volume : shell_volumes(surface)) count += shell_volume > 1e-9 * body_volume;
  return count;
}

}  // namespace crumble::fracture_test
