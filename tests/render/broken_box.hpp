// A 30 mm box broken in two along a ragged plane, and the stick in the crack: something to look at without a
// simulation.
#pragma once

#include <array>
#include <cmath>
#include <map>
#include <utility>

#include "crumble/base/memory.hpp"
#include "crumble/base/random.hpp"
#include "crumble/geometry/convex.hpp"
#include "render/scene.hpp"

namespace crumble::render {

inline constexpr int kBoxCells = 14;
inline constexpr double kBoxEdge = 0.03;

/// Grid of kBoxCells^3 cells, its inner points jittered; the same for every piece, so that the broken faces match.
inline Vec3 grid_point(int i, int j, int k) {
  const auto at = [](int index) { return (static_cast<double>(index) / kBoxCells - 0.5) * kBoxEdge; };
  Vec3 p(at(i), at(j), at(k));
  Random random(static_cast<std::uint64_t>((i * 1000 + j) * 1000 + k));
  const std::array<int, 3> index = {i, j, k};
  for (int axis = 0; axis < 3; ++axis) {
    const double shift = random.uniform(-0.38, 0.38) * kBoxEdge / kBoxCells;
    if (index[axis] > 0 && index[axis] < kBoxCells) p[axis] += shift;
  }
  return p;
}

/// Left of the ragged plane (0) or right of it (1).
inline int piece_of(int i, int j, int k) {
  Random random(static_cast<std::uint64_t>((i * 31 + j) * 31 + k));
  const double wave = 1.1 * std::sin(0.8 * j + 0.4) + 0.9 * std::sin(0.9 * k + 0.25 * j);
  return i + 0.5 - 0.5 * kBoxCells < wave + random.uniform(-0.6, 0.6) ? 0 : 1;
}

/// Grows the surface of one piece, face by face of the grid.
class PieceBuilder {
 public:
  TriangleMesh mesh;
  Vector<Material> materials;

  /// Face `face` (-x +x -y +y -z +z) of a cell, two triangles seen from outside.
  void add_face(const std::array<int, 3>& cell, int face, Material material) {
    constexpr int kAround[4][2] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
    std::array<std::uint32_t, 4> v;
    for (int q = 0; q < 4; ++q) {
      std::array<int, 3> point = cell;
      point[face / 2] += face % 2;
      point[(face / 2 + 1) % 3] += kAround[q][0];
      point[(face / 2 + 2) % 3] += kAround[q][1];
      v[q] = vertex(point);
    }
    if (face % 2 == 0) std::swap(v[1], v[3]);
    mesh.triangles.push_back({v[0], v[1], v[2]});
    mesh.triangles.push_back({v[0], v[2], v[3]});
    materials.insert(materials.end(), 2, material);
  }

 private:
  std::uint32_t vertex(const std::array<int, 3>& p) {
    const auto [at, is_new] = ids_.emplace(p, static_cast<std::uint32_t>(mesh.vertices.size()));
    if (is_new) mesh.vertices.push_back(grid_point(p[0], p[1], p[2]));
    return at->second;
  }
  std::map<std::array<int, 3>, std::uint32_t> ids_;
};

inline PieceBuilder build_piece(int piece) {
  PieceBuilder builder;
  const auto is_inside = [](int a) { return a >= 0 && a < kBoxCells; };
  for (int cell = 0; cell < kBoxCells * kBoxCells * kBoxCells; ++cell) {
    const std::array<int, 3> at = {cell / kBoxCells / kBoxCells, cell / kBoxCells % kBoxCells, cell % kBoxCells};
    if (piece_of(at[0], at[1], at[2]) != piece) continue;
    for (int face = 0; face < 6; ++face) {
      std::array<int, 3> beyond = at;
      beyond[face / 2] += face % 2 == 0 ? -1 : 1;
      const bool is_skin = !is_inside(beyond[face / 2]);
      if (is_skin)
        builder.add_face(at, face, Material::skin);
      else if (piece_of(beyond[0], beyond[1], beyond[2]) != piece)
        builder.add_face(at, face, Material::interior);
    }
  }
  return builder;
}

/// One piece, turned outward by `opening` radians about the box's lower edge on its side, standing on y = 0.
inline RenderMesh make_piece(int piece, double opening) {
  PieceBuilder builder = build_piece(piece);
  const Vector<Vec3> rest = builder.mesh.vertices;
  const double edge = (piece == 0 ? -0.5 : 0.5) * kBoxEdge, c = std::cos(opening);
  const double s = piece == 0 ? -std::sin(opening) : std::sin(opening);
  for (Vec3& p : builder.mesh.vertices) {
    const double x = p.x() - edge, y = p.y() + kBoxEdge / 2;
    p = {edge + c * x + s * y, c * y - s * x, p.z()};
  }
  RenderMesh out = make_render_mesh(builder.mesh, builder.materials, 50);
  out.rest_positions = rest;
  return out;
}

/// The paper's 8 mm stick, axis fore and aft, its lowest line at height `bottom`.
inline RenderMesh make_stick(double bottom) {
  const ConvexPolyhedron stick = make_round_stick(0.004, 0.05, 16);
  RenderMesh out =
      make_render_mesh(stick.surface, Vector<Material>(stick.surface.triangles.size(), Material::wood), 30);
  out.rest_positions = out.positions;
  for (Vec3& p : out.positions) p.y() += bottom + 0.004;
  return out;
}

}  // namespace crumble::render
