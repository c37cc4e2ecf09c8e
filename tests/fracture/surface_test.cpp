// The surface's topology: closed, oriented, 2-manifold, the body's volume at rest, one solid per fragment.
#include "crumble/fracture/surface.hpp"

#include <gtest/gtest.h>

#include <set>

#include "crumble/base/memory.hpp"
#include "crumble/base/text.hpp"
#include "crumble/fracture/masks.hpp"
#include "states.hpp"

namespace crumble {
namespace {

using namespace fracture_test;

::testing::AssertionResult no_defects(const TriangleMesh& surface) {
  const SurfaceDefects defects = find_surface_defects(surface);
  if (defects.total() == 0) return ::testing::AssertionSuccess();
  return ::testing::AssertionFailure() << defects.open_edges << " open, " << defects.nonmanifold_edges
                                       << " non-manifold, " << defects.flipped_edges << " flipped edges, "
                                       << defects.split_vertices << " split vertices";
}

// Extracts states and holds all that must be true of any, in the modes `cracks` and `fragments`.
class Checker {
 public:
  Checker(const TetMesh& mesh, SurfaceMode mode)
      : mesh_(mesh), surface_(mesh, {.mode = mode}), body_volume_(volume(mesh)) {}

  /// Somewhere to come from, not checked.
  void start(const Flags& intact) { surface_.rebuild(Body(mesh_, intact).now()); }
  /// Without a past, or from the last state on, which must have had no other springs cut.
  ::testing::AssertionResult rebuild(const Flags& intact) {
    const Body body(mesh_, intact);
    surface_.rebuild(body.now());
    return check(body);
  }
  ::testing::AssertionResult update(const Flags& intact) {
    const Body body(mesh_, intact);
    surface_.update(body.now());
    if (surface_.rebuilt()) return ::testing::AssertionFailure() << "rebuilt";
    return check(body);
  }
  const SurfaceExtractor& surface() const { return surface_; }
  double worst_volume_error() const { return worst_volume_error_; }

 private:
  ::testing::AssertionResult check(const Body& body) {
    const TriangleMesh rest = rest_surface(surface_);
    if (const auto closed = no_defects(rest); !closed) return closed;
    const double error = std::abs(volume(rest) - body_volume_) / body_volume_;
    worst_volume_error_ = std::max(worst_volume_error_, error);
    if (!(error <= 1e-12)) return ::testing::AssertionFailure() << "volume off by " << error;
    const std::size_t pieces = solid_piece_count(rest, body_volume_);
    if (pieces != label_count(body.labels)) {
      return ::testing::AssertionFailure() << pieces << " solids, " << label_count(body.labels) << " fragments";
    }
    if (rest.triangles.size() > surface_.max_triangle_count() || rest.vertices.size() > surface_.max_vertex_count()) {
      return ::testing::AssertionFailure() << "more than the bounds";
    }
    return ::testing::AssertionSuccess();
  }

  const TetMesh& mesh_;
  SurfaceExtractor surface_;
  double body_volume_;
  double worst_volume_error_ = 0;
};

constexpr std::array<SurfaceMode, 2> kManifoldModes{SurfaceMode::cracks, SurfaceMode::fragments};

Flags flags_from_bits(std::size_t count, unsigned cut_bits) {
  Flags intact(count);
  for (std::size_t s = 0; s < count; ++s) intact[s] = (cut_bits >> s & 1u) == 0;
  return intact;
}

TEST(Surface, LoneTetrahedronInEveryMaskAndNumbering) {
  const Vector<Vec3> points(two_tetrahedra_points().begin(), two_tetrahedra_points().begin() + 4);
  Vector<std::uint32_t> order{0, 1, 2, 3};
  do {
    const TetMesh mesh = make_renumbered(points, {{0, 1, 2, 3}}, order);
    Checker cracks(mesh, SurfaceMode::cracks), fragments(mesh, SurfaceMode::fragments);
    for (unsigned mask = 0; mask < kCutMaskCount; ++mask) {
      ASSERT_TRUE(cracks.rebuild(flags_from_bits(6, mask))) << "mask " << mask << ", first node " << order[0];
      ASSERT_TRUE(fragments.rebuild(flags_from_bits(6, mask))) << "mask " << mask << ", first node " << order[0];
      const std::size_t interior = cracks.surface().triangles().size() - cracks.surface().skin_triangle_count();
      ASSERT_EQ(interior, 4u * static_cast<unsigned>(std::popcount(mask)));
      if (kCutMasks[mask].piece_count == 1) {
        ASSERT_EQ(fragments.surface().triangles().size(), 4u) << mask;
      }
    }
  } while (std::next_permutation(order.begin(), order.end()));
}

// From every mask to every mask that can follow it.
TEST(Surface, LoneTetrahedronInEveryTransition) {
  const Vector<Vec3> points(two_tetrahedra_points().begin(), two_tetrahedra_points().begin() + 4);
  Vector<std::uint32_t> order{0, 1, 2, 3};
  do {
    const TetMesh mesh = make_renumbered(points, {{0, 1, 2, 3}}, order);
    for (const SurfaceMode mode : kManifoldModes) {
      Checker checker(mesh, mode);
      for (unsigned from = 0; from < kCutMaskCount; ++from) {
        for (unsigned to = 0; to < kCutMaskCount; ++to) {
          if ((from & ~to) != 0) continue;
          checker.start(flags_from_bits(6, from));
          ASSERT_TRUE(checker.update(flags_from_bits(6, to))) << from << " to " << to;
        }
      }
    }
  } while (std::next_permutation(order.begin(), order.end()));
}

TEST(Surface, TwoTetrahedraWithACommonFaceInEveryState) {
  Random random(11);
  for (int numbering = 0; numbering < 10; ++numbering) {
    const TetMesh mesh =
        make_renumbered(two_tetrahedra_points(), {{0, 1, 2, 3}, {0, 2, 1, 4}}, random_order(5, random));
    ASSERT_EQ(mesh.springs.size(), 9u);
    for (const SurfaceMode mode : kManifoldModes) {
      Checker checker(mesh, mode);
      for (unsigned cut = 0; cut < 512; ++cut) {
        ASSERT_TRUE(checker.rebuild(flags_from_bits(9, cut))) << "cut " << cut;
        checker.start(flags_from_bits(9, cut & static_cast<unsigned>(random.below(512))));
        ASSERT_TRUE(checker.update(flags_from_bits(9, cut))) << "cut " << cut;
      }
    }
  }
}

TEST(Surface, FiveTetrahedraRoundAnEdgeInRandomStates) {
  Random random(12);
  for (int numbering = 0; numbering < 50; ++numbering) {
    const TetMesh mesh = make_ring(5, 1, 0.8, random_order(7, random));
    ASSERT_EQ(mesh.springs.size(), 16u);
    for (const SurfaceMode mode : kManifoldModes) {
      Checker checker(mesh, mode);
      for (int state = 0; state < 100; ++state) {
        const Flags intact = random_flags(16, random.uniform(), random);
        Flags before = intact;
        for (std::uint8_t& flag : before) flag = flag != 0 || random.uniform() < 0.5;
        ASSERT_TRUE(checker.rebuild(intact)) << numbering << " " << state;
        checker.start(before);
        ASSERT_TRUE(checker.update(intact)) << numbering << " " << state;
      }
    }
  }
}

TEST(Surface, BoxInRandomStates) {
  Random random(13);
  const TetMesh mesh = make_lattice_box({0.03, 0.03, 0.02}, 0.005);
  double worst_volume_error = 0;
  for (const SurfaceMode mode : kManifoldModes) {
    Checker checker(mesh, mode);
    for (int state = 0; state < 48; ++state) {
      ASSERT_TRUE(checker.rebuild(random_flags(mesh.springs.size(), 0.02 * (state + 1), random))) << state;
    }
    worst_volume_error = std::max(worst_volume_error, checker.worst_volume_error());
  }
  RecordProperty("worst_volume_error", to_text(worst_volume_error));
}

// Cut by cut from whole to dust.
TEST(Surface, BoxInRandomSequences) {
  Random random(18);
  const TetMesh mesh = make_lattice_box({0.02, 0.02, 0.02}, 0.005);
  for (const SurfaceMode mode : kManifoldModes) {
    for (const std::size_t burst : {std::size_t{10}, std::size_t{60}}) {
      Checker checker(mesh, mode);
      Flags intact(mesh.springs.size(), 1);
      ASSERT_TRUE(checker.rebuild(intact));
      const auto order = random_order(mesh.springs.size(), random);
      for (std::size_t next = 0; next < order.size(); ++next) {
        intact[order[next]] = 0;
        if (next % burst != 0 && next + 1 != order.size()) continue;
        ASSERT_TRUE(checker.update(intact)) << next;
      }
    }
  }
}

// A fragment's own surface is closed round the dual cells of its nodes, and what it says of its origin is true.
TEST(Surface, FragmentSurfacesEncloseTheirDualCells) {
  Random random(16);
  const TetMesh mesh = make_lattice_box({0.03, 0.03, 0.02}, 0.005);
  for (const SurfaceMode mode : kManifoldModes) {
    SurfaceExtractor surface(mesh, {.mode = mode});
    for (int state = 0; state < 8; ++state) {
      Flags intact = random_flags(mesh.springs.size(), 0.09 * state, random);
      for (std::size_t s = 0; s < intact.size(); ++s) {  // and a plane through the middle
        const auto [a, b] = mesh.springs[s];
        if ((mesh.positions[a].x() < 0.001) != (mesh.positions[b].x() < 0.001)) intact[s] = 0;
      }
      const Body body(mesh, intact);
      ASSERT_GE(label_count(body.labels), 2u);
      surface.rebuild(body.now());
      Vector<double> cells(label_count(body.labels));
      for (std::size_t i = 0; i < body.labels.size(); ++i) cells[body.labels[i]] += mesh.node_volumes[i];
      std::size_t triangle_count = 0;
      for (std::uint32_t f = 0; f < cells.size(); ++f) {
        const FragmentSurface part = fragment_surface(surface, f);
        ASSERT_TRUE(no_defects(part.mesh)) << "fragment " << f;
        ASSERT_NEAR(volume(part.mesh), cells[f], 1e-12 * volume(mesh)) << "fragment " << f;
        ASSERT_EQ(part.vertices.size(), part.mesh.vertices.size());
        ASSERT_EQ(part.triangles.size(), part.mesh.triangles.size());
        triangle_count += part.triangles.size();
        for (std::size_t t = 0; t < part.triangles.size(); ++t) {
          ASSERT_EQ(surface.fragments()[part.triangles[t]], f);
          for (std::size_t k = 0; k < 3; ++k) {
            const std::uint32_t v = part.mesh.triangles[t][k];
            ASSERT_EQ(part.vertices[v], surface.triangles()[part.triangles[t]][k]);
            ASSERT_EQ(part.mesh.vertices[v], surface.positions()[part.vertices[v]]);
          }
        }
      }
      ASSERT_EQ(triangle_count, surface.triangles().size());
      EXPECT_TRUE(fragment_surface(surface, kNoFragment).triangles.empty());
    }
  }
}

TEST(Surface, BoundsAreReachedWhenEverythingIsCut) {
  Random random(14);
  const TetMesh box = make_lattice_box({0.03, 0.03, 0.03}, 0.01);
  const TetMesh lone = make_tet_mesh({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, {{0, 1, 2, 3}});
  for (const TetMesh* mesh : {&box, &lone}) {
    Checker checker(*mesh, SurfaceMode::cracks);
    ASSERT_TRUE(checker.rebuild(Flags(mesh->springs.size(), 0)));
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
  surface.update(Body(mesh, intact).now());
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
