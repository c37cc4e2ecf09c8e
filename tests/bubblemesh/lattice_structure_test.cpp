// structure = lattice: neighbours are lattice neighbours, nodes stand on the lattice, and the bodies are whole.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <sstream>

#include "crumble/base/error.hpp"
#include "crumble/base/hash.hpp"
#include "crumble/base/memory.hpp"
#include "crumble/base/random.hpp"
#include "crumble/bubblemesh/generate.hpp"

namespace crumble {
namespace {

BubbleMesh lattice_of(const Shape& shape, double spacing, const Vec3& offset = Vec3::Zero()) {
  BubbleMeshOptions options;
  options.spacing = spacing;
  options.offset = offset;
  options.structure = Structure::lattice;
  return generate(shape, options);
}

/// Where the perfect lattice has a node, in spacings, from its layer, row and place: written down a second time, from
/// the words in docs/mesh.md.
Vector<Vec3> perfect_points(const BubbleMesh& body) {
  Vector<Vec3> points;
  for (const LatticeRow& row : body.rows) {
    for (std::uint32_t k = 0; k < row.count; ++k) {
      const double shift = row.layer % 2 == 0 ? 0 : 0.5;
      points.emplace_back(body.places[row.first + k] + shift, row.layer / std::sqrt(2.0), row.row + shift);
    }
  }
  return points;
}

TEST(LatticeStructure, FlagsTellLatticeNeighbours) {
  for (const auto& shape : {make_box({9, 7.3, 8}), make_sphere(4), make_cylinder(3.5, 8)}) {
    const BubbleMesh body = lattice_of(*shape, 1, {0.2, 0.6, 0.4});
    const Vector<Vec3> points = perfect_points(body);
    ASSERT_EQ(points.size(), body.mesh.node_count());
    ASSERT_EQ(body.lattice_neighbours.size(), body.mesh.springs.size());
    std::size_t others = 0;
    for (std::size_t s = 0; s < body.mesh.springs.size(); ++s) {
      const auto& [i, j] = body.mesh.springs[s];
      const Vec3 step = points[j] - points[i];
      const double squares = squared_norm(step);
      const bool upright = std::abs(squares - 2) < 1e-9 && step.x() == 0 && step.z() == 0;
      EXPECT_EQ(body.lattice_neighbours[s] == 1, std::abs(squares - 1) < 1e-9 || upright) << s;
      // what is not a neighbour is another diagonal of an octahedron, at the surface
      if (body.lattice_neighbours[s]) continue;
      EXPECT_NEAR(squares, 2, 1e-9) << s;
      EXPECT_TRUE(body.mesh.kinds[i] != NodeKind::inside || body.mesh.kinds[j] != NodeKind::inside) << s;
      ++others;
    }
    EXPECT_LT(static_cast<double>(others) / static_cast<double>(body.mesh.springs.size()), 0.06);
  }
}

TEST(LatticeStructure, EveryInnerNodeHasAllItsNeighbours) {
  const BubbleMesh body = lattice_of(*make_box({12, 12, 12}), 1);
  const Vector<Vec3> points = perfect_points(body);
  Vector<int> nearest(points.size(), 0), upright(points.size(), 0), level_with_surface(points.size(), 0);
  for (const auto& [i, j] : body.mesh.springs) {
    const bool is_near = std::abs(squared_norm(points[j] - points[i]) - 1) < 1e-9;
    for (const std::uint32_t v : {i, j}) ++(is_near ? nearest : upright)[v];
    if (body.mesh.kinds[i] != NodeKind::inside) level_with_surface[j] = 1;
    if (body.mesh.kinds[j] != NodeKind::inside) level_with_surface[i] = 1;
  }
  std::size_t inner = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (body.mesh.kinds[i] != NodeKind::inside) continue;
    EXPECT_EQ(nearest[i], 12) << i;
    if (level_with_surface[i]) continue;
    EXPECT_EQ(upright[i], 2) << i;
    ++inner;
  }
  EXPECT_GT(inner, 900u);
}

TEST(LatticeStructure, NeighboursInARowHaveOneOffset) {
  const BubbleMesh body = lattice_of(*make_box({11, 9, 10}), 1);
  const Vector<Vec3> points = perfect_points(body);
  Vector<std::size_t> row_of(points.size());
  for (std::size_t r = 0; r < body.rows.size(); ++r) {
    for (std::uint32_t k = 0; k < body.rows[r].count; ++k) row_of[body.rows[r].first + k] = r;
  }
  // per row and direction in halves of a square, rounded
  std::map<std::array<std::int64_t, 4>, std::set<std::uint32_t>> offsets;
  for (std::size_t s = 0; s < body.mesh.springs.size(); ++s) {
    if (!body.lattice_neighbours[s]) continue;
    const auto& [i, j] = body.mesh.springs[s];
    const Vec3 step = 4 * (points[j] - points[i]);
    offsets[{static_cast<std::int64_t>(row_of[i]), std::lround(step.x()), std::lround(step.y()), std::lround(step.z())}]
        .insert(j - i);
  }
  for (const auto& [key, values] : offsets) EXPECT_EQ(values.size(), 1u) << "row " << key[0];
  EXPECT_GT(share_in_runs(body.mesh, 4), 0.99);
}

TEST(LatticeStructure, InnerNodesStandOnTheLattice) {
  // nothing is stretched in a sphere; powers of two make the steps exact
  const double spacing = 0.25;
  const BubbleMesh body = lattice_of(*make_sphere(2), spacing, {0.25, 0, 0.5});
  const Vector<Vec3> points = perfect_points(body);
  std::size_t inner = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (body.mesh.kinds[i] != NodeKind::inside) continue;
    const Vec3& p = body.mesh.positions[i];
    EXPECT_EQ(p.x(), spacing * (points[i].x() + 0.25));
    EXPECT_NEAR(p.y(), 2 + spacing * points[i].y(), 1e-15);
    EXPECT_EQ(p.z(), spacing * (points[i].z() + 0.5));
    ++inner;
  }
  EXPECT_GT(inner, 1500u);  // 4/3 pi 8^3 sqrt 2 = 3033 balls, less the surface's
}

TEST(LatticeStructure, BoxesAreFitted) {
  const Vec3 size(0.0307, 0.0213, 0.0255);
  const auto box = make_box(size);
  const BubbleMesh body = lattice_of(*box, 0.003, {0.3, 0.1, 0.7});
  EXPECT_LE(std::abs(body.volume_error), 1e-12);
  EXPECT_EQ(std::ranges::count(body.mesh.kinds, NodeKind::corner), 8);
  std::set<double> xs, ys, zs;  // of nodes inside: equal steps
  for (std::size_t i = 0; i < body.mesh.node_count(); ++i) {
    const Vec3& p = body.mesh.positions[i];
    const double distance = box->signed_distance(p);
    if (body.mesh.kinds[i] != NodeKind::inside) {
      EXPECT_LE(std::abs(distance), 1e-17) << i;
      continue;
    }
    EXPECT_LT(distance, -0.3 * 0.003);
    xs.insert(p.x()), ys.insert(p.y()), zs.insert(p.z());
  }
  const auto expect_steps = [](const std::set<double>& values, double step) {
    for (auto next = std::next(values.begin()); next != values.end(); ++next) {
      const double gap = *next - *std::prev(next);
      EXPECT_TRUE(gap < 1e-12 || std::abs(gap - step) < 1e-12) << gap << " instead of " << step;
    }
  };
  expect_steps(xs, size.x() / 20);  // half squares: 30.7 / 1.5 = 20.5 is rounded up to
  expect_steps(ys, size.y() / 10);  // layers
  expect_steps(zs, size.z() / 17);
}

std::uint64_t hash_of(const TetMesh& mesh) {
  Hash hash;
  for (const Vec3& p : mesh.positions) hash.add(p.x()), hash.add(p.y()), hash.add(p.z());
  for (const Tetrahedron& t : mesh.tetrahedra) {
    for (const std::uint32_t v : t) hash.add(std::uint64_t{v});
  }
  return hash.value();
}

// The same bits from every compiler at every level of optimisation.
TEST(LatticeStructure, HasItsGoldenHash) {
  EXPECT_EQ(hash_of(lattice_of(*make_box({0.03, 0.03, 0.03}), 0.0031).mesh), 0x491f3185ed69d85fu);
  EXPECT_EQ(hash_of(lattice_of(*make_sphere(0.02), 0.0044, {0.3, 0.1, 0.7}).mesh), 0xd2f868231da96598u);
}

struct Body {
  std::unique_ptr<Shape> shape;
  std::string text;
};
Body random_body(std::uint64_t seed) {
  Random random(seed);
  std::ostringstream text;
  text << "seed " << seed << ": ";
  const double thickness = random.uniform(2, 9), a = thickness * random.uniform(1, 3),
               b = thickness * random.uniform(1, 3);
  if (seed % 3 == 0) {
    text << "box " << a << ' ' << thickness << ' ' << b;
    return {make_box({a, thickness, b}), text.str()};
  }
  if (seed % 3 == 1) {
    text << "sphere " << thickness / 2;
    return {make_sphere(thickness / 2), text.str()};
  }
  text << "cylinder " << thickness / 2 << ' ' << a;
  return {make_cylinder(thickness / 2, a), text.str()};
}

// generate() has checked the surface and Euler's number already; here the tetrahedra are looked at one by one.
TEST(LatticeStructure, RandomBodiesAreWhole) {
  for (std::uint64_t seed = 0; seed < 90; ++seed) {
    const Body body = random_body(seed);
    SCOPED_TRACE(body.text);
    Random random(seed + 1000);
    const BubbleMesh result = lattice_of(*body.shape, 1, {random.uniform(), random.uniform(), random.uniform()});
    const MeshQuality& q = result.quality;
    EXPECT_EQ(q.boundary_defects.total(), 0u);
    EXPECT_EQ(q.euler_defect, 0);
    EXPECT_GE(q.dihedral_min, seed % 3 == 0 ? 30 : 20);
    EXPECT_LE(q.dihedral_max, 145);
    const double exact = seed % 3 == 0 ? 1e-12 : 0.6 * std::pow(2 / body.shape->least_thickness(), 2);
    EXPECT_LE(std::abs(result.volume_error), exact);
    const TetMesh& mesh = result.mesh;
    double sum = 0;
    for (const Tetrahedron& t : mesh.tetrahedra) {
      const double volume =
          orient(mesh.positions[t[0]], mesh.positions[t[1]], mesh.positions[t[2]], mesh.positions[t[3]]) / 6;
      EXPECT_GT(volume, 0.02);  // a regular tetrahedron has 0.118
      sum += volume;
    }
    EXPECT_NEAR(sum / (volume(TriangleMesh{mesh.positions, mesh.boundary})), 1, 1e-10);
  }
}

TEST(LatticeStructure, WarnsOfLostVolume) {
  EXPECT_TRUE(lattice_of(*make_sphere(4), 1).warnings.empty());
  const BubbleMesh small = lattice_of(*make_sphere(1.2), 1);
  ASSERT_EQ(small.warnings.size(), 1u);
  EXPECT_NE(small.warnings[0].find("volume"), std::string::npos);
}

TEST(LatticeStructure, RefusesWhatItCannotDo) {
  const auto cube = make_box({3, 3, 3});
  const auto code_of = [&](const BubbleMeshOptions& options, const std::string& word) {
    try {
      generate(*cube, options);
    } catch (const Error& error) {
      EXPECT_NE(std::string(error.what()).find(word), std::string::npos) << error.what();
      return error.code();
    }
    return Code::internal;
  };
  BubbleMeshOptions options;
  options.structure = Structure::lattice;
  options.spacing = 1.6;
  EXPECT_EQ(code_of(options, "at most 1.5 m"), Code::too_coarse);
  options.spacing = 1;
  options.surface_nodes = options.inside_nodes = 20;
  EXPECT_EQ(code_of(options, "structure lattice"), Code::unsupported);
  EXPECT_NO_THROW(lattice_of(*cube, largest_spacing(*cube, Structure::lattice)));
}

}  // namespace
}  // namespace crumble
