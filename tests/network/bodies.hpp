// Bodies for the network's tests: rows of a crystal, bubble meshes, and meshes that have no order at all.
#pragma once

#include <numeric>
#include <string>
#include <utility>

#include "bubblemesh/delaunay.hpp"
#include "crumble/base/memory.hpp"
#include "crumble/base/random.hpp"
#include "crumble/bubblemesh/generate.hpp"
#include "crumble/tetmesh/lattice_box.hpp"

namespace crumble {

inline Vec3 random_vector(Random& random, double size) {
  return size * Vec3(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1));
}

inline Vector<std::uint32_t> random_order(std::size_t count, Random& random) {
  Vector<std::uint32_t> order(count);
  std::iota(order.begin(), order.end(), 0u);
  for (std::size_t i = count; i > 1; --i) std::swap(order[i - 1], order[random.below(i)]);
  return order;
}

/// Node i becomes node order[i].
inline TetMesh renumbered(const TetMesh& mesh, const Vector<std::uint32_t>& order) {
  Vector<Vec3> positions(mesh.node_count());
  for (std::size_t i = 0; i < positions.size(); ++i) positions[order[i]] = mesh.positions[i];
  Vector<Tetrahedron> tetrahedra = mesh.tetrahedra;
  for (Tetrahedron& t : tetrahedra) {
    for (std::uint32_t& node : t) node = order[node];
  }
  return make_tet_mesh(std::move(positions), std::move(tetrahedra));
}

inline TetMesh shuffled(const TetMesh& mesh, Random& random) {
  return renumbered(mesh, random_order(mesh.node_count(), random));
}

/// Delaunay tetrahedra of random points in a cube of 30 mm: what a user might bring.
inline TetMesh random_mesh(std::size_t points, Random& random) {
  Vector<Vec3> positions;
  for (std::size_t i = 0; i < points; ++i) positions.push_back(random_vector(random, 0.015));
  Vector<Tetrahedron> good;
  for (const Tetrahedron& t : delaunay(quantize(positions))) {  // of points in a plane there may be flat ones
    if (orient(positions[t[0]], positions[t[1]], positions[t[2]], positions[t[3]]) > 1e-12) good.push_back(t);
  }
  Vector<std::uint32_t> name(points, 0);
  for (const Tetrahedron& t : good) {
    for (const std::uint32_t node : t) name[node] = 1;
  }
  Vector<Vec3> kept;
  for (std::size_t i = 0; i < points; ++i) {
    if (name[i] == 0) continue;
    name[i] = static_cast<std::uint32_t>(kept.size());
    kept.push_back(positions[i]);
  }
  for (Tetrahedron& t : good) {
    for (std::uint32_t& node : t) node = name[node];
  }
  return make_tet_mesh(std::move(kept), std::move(good));
}

inline TetMesh bubble_cube(double edge, double spacing, Structure structure) {
  BubbleMeshOptions options;
  options.spacing = spacing;
  options.structure = structure;
  return generate(*make_box({edge, edge, edge}), options).mesh;
}

struct Body {
  std::string name;
  TetMesh mesh;
};

/// One of each kind, up to some hundreds of nodes.
inline Vector<Body> small_bodies() {
  Random random(23);
  Vector<Body> bodies;
  bodies.push_back(
      {"one tetrahedron", make_tet_mesh({{0, 0, 0}, {0.01, 0, 0}, {0, 0.01, 0}, {0, 0, 0.01}}, {{0, 1, 2, 3}})});
  for (const std::size_t points : {6u, 9u, 14u, 20u}) {
    bodies.push_back({std::to_string(points) + " points", random_mesh(points, random)});
  }
  bodies.push_back({"box of 27", make_lattice_box({0.02, 0.02, 0.02}, 0.01)});
  bodies.push_back({"long box", make_lattice_box({0.1, 0.006, 0.008}, 0.002)});
  bodies.push_back({"flat box", make_lattice_box({0.03, 0.002, 0.02}, 0.0017)});
  bodies.push_back({"relaxed cube", bubble_cube(0.02, 0.0044, Structure::relaxed)});
  bodies.push_back({"lattice cube", bubble_cube(0.03, 0.0044, Structure::lattice)});
  bodies.push_back({"shuffled box", shuffled(make_lattice_box({0.03, 0.02, 0.02}, 0.004), random)});
  bodies.push_back({"400 points", random_mesh(400, random)});
  return bodies;
}

}  // namespace crumble
