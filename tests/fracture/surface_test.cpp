// The surface's topology: closed, oriented, 2-manifold, the body's volume at rest, one solid per fragment.
#include "crumble/fracture/surface.hpp"

#include <gtest/gtest.h>

#include <set>

#include "crumble/base/text.hpp"
#include "crumble/fracture/masks.hpp"
#include "states.hpp"

namespace crumble {
namespace {

using namespace fracture_test;

// Extracts one state and holds all that must be true of any.
class Checker {
 public:
  explicit Checker(const TetMesh& mesh) : mesh_(mesh), surface_(mesh), body_volume_(volume(mesh)) {}

  ::testing::AssertionResult check(const Flags& intact) {
    const std::vector<std::uint32_t> labels = flood_labels(mesh_, intact);
    surface_.extract(intact, labels);
    const TriangleMesh rest = rest_surface(surface_);
    const SurfaceDefects defects = find_surface_defects(rest);
    if (defects.total() != 0) {
      return ::testing::AssertionFailure()
             << defects.open_edges << " open, " << defects.nonmanifold_edges << " non-manifold, "
             << defects.flipped_edges << " flipped edges, " << defects.split_vertices << " split vertices";
    }
    const double error = std::abs(volume(rest) - body_volume_) / body_volume_;
    worst_volume_error_ = std::max(worst_volume_error_, error);
    if (!(error <= 1e-12)) return ::testing::AssertionFailure() << "volume off by " << error;
    const std::size_t pieces = solid_piece_count(rest, body_volume_);
    if (pieces != label_count(labels)) {
      return ::testing::AssertionFailure() << pieces << " solids, " << label_count(labels) << " fragments";
    }
    if (rest.triangles.size() > surface_.max_triangle_count() || rest.vertices.size() > surface_.max_vertex_count()) {
      return ::testing::AssertionFailure() << "more than the bounds";
    }
    return ::testing::AssertionSuccess();
  }
  const SurfaceExtractor& surface() const { return surface_; }
  double worst_volume_error() const { return worst_volume_error_; }

 private:
  const TetMesh& mesh_;
  SurfaceExtractor surface_;
  double body_volume_;
  double worst_volume_error_ = 0;
};

Flags flags_from_bits(std::size_t count, unsigned cut_bits) {
  Flags intact(count);
  for (std::size_t s = 0; s < count; ++s) intact[s] = (cut_bits >> s & 1u) == 0;
  return intact;
}

TEST(Surface, LoneTetrahedronInEveryMaskAndNumbering) {
  const std::vector<Vec3> points(two_tetrahedra_points().begin(), two_tetrahedra_points().begin() + 4);
  std::vector<std::uint32_t> order{0, 1, 2, 3};
  do {
    const TetMesh mesh = make_renumbered(points, {{0, 1, 2, 3}}, order);
    Checker checker(mesh);
    for (unsigned mask = 0; mask < kCutMaskCount; ++mask) {
      ASSERT_TRUE(checker.check(flags_from_bits(6, mask))) << "mask " << mask << ", first node " << order[0];
      const std::size_t interior = checker.surface().triangles().size() - checker.surface().skin_triangle_count();
      ASSERT_EQ(interior, 4u * static_cast<unsigned>(std::popcount(mask)));
    }
  } while (std::next_permutation(order.begin(), order.end()));
}

TEST(Surface, TwoTetrahedraWithACommonFaceInEveryState) {
  Random random(11);
  for (int numbering = 0; numbering < 10; ++numbering) {
    const TetMesh mesh =
        make_renumbered(two_tetrahedra_points(), {{0, 1, 2, 3}, {0, 2, 1, 4}}, random_order(5, random));
    ASSERT_EQ(mesh.springs.size(), 9u);
    Checker checker(mesh);
    for (unsigned cut = 0; cut < 512; ++cut) ASSERT_TRUE(checker.check(flags_from_bits(9, cut))) << "cut " << cut;
  }
}

TEST(Surface, FiveTetrahedraRoundAnEdgeInRandomStates) {
  Random random(12);
  for (int numbering = 0; numbering < 50; ++numbering) {
    const TetMesh mesh = make_ring(5, 1, 0.8, random_order(7, random));
    ASSERT_EQ(mesh.springs.size(), 16u);
    Checker checker(mesh);
    for (int state = 0; state < 100; ++state) {
      ASSERT_TRUE(checker.check(random_flags(16, random.uniform(), random))) << numbering << " " << state;
    }
  }
}

TEST(Surface, BoxInRandomStates) {
  Random random(13);
  const TetMesh mesh = make_lattice_box({0.03, 0.03, 0.02}, 0.005);
  Checker checker(mesh);
  for (int state = 0; state < 48; ++state) {
    ASSERT_TRUE(checker.check(random_flags(mesh.springs.size(), 0.02 * (state + 1), random))) << state;
  }
  RecordProperty("worst_volume_error", to_text(checker.worst_volume_error()));
}

// The triangles of a fragment alone are its closed surface, round the dual cells of its nodes.
TEST(Surface, TrianglesOfAFragmentEncloseItsDualCells) {
  Random random(16);
  const TetMesh mesh = make_lattice_box({0.03, 0.03, 0.02}, 0.005);
  SurfaceExtractor surface(mesh);
  for (int state = 0; state < 8; ++state) {
    Flags intact = random_flags(mesh.springs.size(), 0.09 * state, random);
    for (std::size_t s = 0; s < intact.size(); ++s) {  // and a plane through the middle
      const auto [a, b] = mesh.springs[s];
      if ((mesh.positions[a].x() < 0.001) != (mesh.positions[b].x() < 0.001)) intact[s] = 0;
    }
    const auto labels = flood_labels(mesh, intact);
    ASSERT_GE(label_count(labels), 2u);
    surface.extract(intact, labels);
    std::vector<TriangleMesh> parts(label_count(labels), {rest_surface(surface).vertices, {}});
    for (std::size_t t = 0; t < surface.triangles().size(); ++t) {
      parts[surface.fragments()[t]].triangles.push_back(surface.triangles()[t]);
    }
    std::vector<double> cells(parts.size());
    for (std::size_t i = 0; i < labels.size(); ++i) cells[labels[i]] += mesh.node_volumes[i];
    for (std::size_t f = 0; f < parts.size(); ++f) {
      EXPECT_EQ(find_surface_defects(parts[f]).total(), 0u) << "fragment " << f;
      EXPECT_NEAR(volume(parts[f]), cells[f], 1e-12 * volume(mesh)) << "fragment " << f;
    }
  }
}

TEST(Surface, BoundsAreReachedWhenEverythingIsCut) {
  Random random(14);
  const TetMesh box = make_lattice_box({0.03, 0.03, 0.03}, 0.01);
  const TetMesh lone = make_tet_mesh({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, {{0, 1, 2, 3}});
  for (const TetMesh* mesh : {&box, &lone}) {
    Checker checker(*mesh);
    ASSERT_TRUE(checker.check(Flags(mesh->springs.size(), 0)));
    const std::size_t tets = mesh->tetrahedra.size(), outer = mesh->boundary.size();
    const std::size_t faces = (4 * tets + outer) / 2;
    std::set<std::uint32_t> outer_nodes;
    for (const Triangle& t : mesh->boundary) outer_nodes.insert(t.begin(), t.end());
    const auto& surface = checker.surface();
    EXPECT_EQ(surface.max_triangle_count(), 24 * tets + 6 * outer);
    EXPECT_EQ(surface.max_vertex_count(), outer_nodes.size() + 2 * mesh->springs.size() + 3 * faces + 4 * tets);
    EXPECT_EQ(surface.triangles().size(), surface.max_triangle_count());
    EXPECT_EQ(surface.positions().size(), surface.max_vertex_count());
  }
}

// What a triangle says of itself: skin lies in the boundary planes, its tetrahedron contains it, its fragment's nodes
// are among its tetrahedron's corners.
TEST(Surface, TrianglesKnowWhereTheyComeFrom) {
  Random random(15);
  const Vec3 size(0.03, 0.02, 0.03);
  const TetMesh mesh = make_lattice_box(size, 0.01);
  const Flags intact = random_flags(mesh.springs.size(), 0.4, random);
  const auto labels = flood_labels(mesh, intact);
  SurfaceExtractor surface(mesh);
  surface.extract(intact, labels);
  for (std::size_t t = 0; t < surface.triangles().size(); ++t) {
    Vec3 middle = Vec3::Zero();
    for (const std::uint32_t v : surface.triangles()[t]) middle += surface.rest_positions()[v] / 3;
    const double to_skin = std::min(
        {middle.y(), size.y() - middle.y(), size.x() / 2 - std::abs(middle.x()), size.z() / 2 - std::abs(middle.z())});
    EXPECT_EQ(t < surface.skin_triangle_count(), std::abs(to_skin) < 1e-9);
    const Tetrahedron& nodes = mesh.tetrahedra[surface.tetrahedra()[t]];
    bool has_fragment = false;
    for (std::size_t f = 0; f < 4; ++f) {
      const auto [a, b, c] = kTetFaces[f];
      const Vec3 &pa = mesh.positions[nodes[a]], &pb = mesh.positions[nodes[b]], &pc = mesh.positions[nodes[c]];
      EXPECT_LE(orient(pa, pb, pc, middle), 1e-15);  // not outside of any face
      has_fragment = has_fragment || labels[nodes[f]] == surface.fragments()[t];
    }
    EXPECT_TRUE(has_fragment);
  }
}

}  // namespace
}  // namespace crumble
