// One picture after another: what the extractor keeps, what it says it has changed, and what the skin stems from.
#include <gtest/gtest.h>

#include <array>
#include <limits>
#include <map>
#include <set>

#include "crumble/base/error.hpp"
#include "crumble/base/memory.hpp"
#include "crumble/fracture/masks.hpp"
#include "states.hpp"

namespace crumble {
namespace {

using namespace fracture_test;

constexpr std::array<SurfaceMode, 3> kModes{SurfaceMode::cracks, SurfaceMode::fragments, SurfaceMode::paper};

TetMesh small_box() {
  return make_lattice_box({0.02, 0.015, 0.015}, 0.005);
}

using Key = std::array<double, 3>;
Key key(const Vec3& p) {
  return {p.x(), p.y(), p.z()};
}

// A triangle without its numbers: where it is from, skin or not, fragment, its places at rest from the least on.
using Named = std::tuple<std::uint32_t, bool, std::uint32_t, std::array<Key, 3>>;
std::multiset<Named> named_triangles(const SurfaceExtractor& surface) {
  std::multiset<Named> named;
  for (std::size_t t = 0; t < surface.triangles().size(); ++t) {
    std::array<Key, 3> places;
    for (std::size_t k = 0; k < 3; ++k) places[k] = key(surface.rest_positions()[surface.triangles()[t][k]]);
    std::rotate(places.begin(), std::min_element(places.begin(), places.end()), places.end());
    named.insert({surface.tetrahedra()[t], t < surface.skin_triangle_count(), surface.fragments()[t], places});
  }
  return named;
}

// Keeps copies of the arrays by uploading nothing but what is said to have changed.
class Renderer {
 public:
  void follow(const SurfaceExtractor& surface) {
    const auto fits = [](std::span<const std::uint32_t> changed, std::size_t count) {
      const std::set<std::uint32_t> once(changed.begin(), changed.end());
      EXPECT_EQ(once.size(), changed.size());
      EXPECT_TRUE(once.empty() || *once.rbegin() < count);
    };
    fits(surface.changed_triangles(), surface.triangles().size());
    fits(surface.changed_vertices(), surface.positions().size());
    triangles_.resize(surface.triangles().size());
    fragments_.resize(surface.triangles().size());
    is_skin_.resize(surface.triangles().size());
    rest_.resize(surface.positions().size());
    for (const std::uint32_t t : surface.changed_triangles()) {
      triangles_[t] = surface.triangles()[t];
      fragments_[t] = surface.fragments()[t];
      is_skin_[t] = t < surface.skin_triangle_count();
    }
    for (const std::uint32_t v : surface.changed_vertices()) rest_[v] = surface.rest_positions()[v];
  }
  ::testing::AssertionResult agrees(const SurfaceExtractor& surface) const {
    const auto same = [](const auto& kept, const auto& span) {
      return std::equal(kept.begin(), kept.end(), span.begin(), span.end());
    };
    if (!same(triangles_, surface.triangles())) return ::testing::AssertionFailure() << "triangles";
    if (!same(fragments_, surface.fragments())) return ::testing::AssertionFailure() << "fragments";
    if (!same(rest_, surface.rest_positions())) return ::testing::AssertionFailure() << "rest positions";
    for (std::size_t t = 0; t < is_skin_.size(); ++t) {
      if (is_skin_[t] != (t < surface.skin_triangle_count())) return ::testing::AssertionFailure() << "skin " << t;
    }
    return ::testing::AssertionSuccess();
  }

 private:
  Vector<Triangle> triangles_;
  Vector<std::uint32_t> fragments_;
  Vector<bool> is_skin_;
  Vector<Vec3> rest_;
};

::testing::AssertionResult every_vertex_is_used(const SurfaceExtractor& surface) {
  Vector<bool> used(surface.positions().size());
  for (const Triangle& triangle : surface.triangles()) {
    for (const std::uint32_t v : triangle) {
      if (v >= used.size()) return ::testing::AssertionFailure() << "no vertex " << v;
      used[v] = true;
    }
  }
  const auto idle = std::find(used.begin(), used.end(), false);
  if (idle == used.end()) return ::testing::AssertionSuccess();
  return ::testing::AssertionFailure() << "vertex " << idle - used.begin() << " without a triangle";
}

// Of a box at rest, whose skin and whose cracks have flat facets.
::testing::AssertionResult normals_are_flat(const SurfaceExtractor& surface) {
  for (std::size_t t = 0; t < surface.triangles().size(); ++t) {
    const auto [a, b, c] = surface.triangles()[t];
    const auto& p = surface.rest_positions();
    const Eigen::Vector3f flat = normalized(cross(p[b] - p[a], p[c] - p[a])).cast<float>();
    for (const Eigen::Vector3f& normal : surface.corner_normals()[t]) {
      if (!((normal - flat).norm() < 1e-5f)) return ::testing::AssertionFailure() << "triangle " << t;
    }
  }
  return ::testing::AssertionSuccess();
}

// Removes one fragment, now and then, as a host does with debris.
void remove_some(std::set<std::uint32_t>& removed, Body& body, Random& random) {
  body.label_by_least_node();
  if (random.uniform() < 0.3) {
    const std::uint32_t victim = body.labels[random.below(body.labels.size())];
    for (std::uint32_t i = 0; i < body.labels.size(); ++i) {
      if (victim != body.labels[0] && body.labels[i] == victim) removed.insert(i);
    }
  }
  for (const std::uint32_t node : removed) body.labels[node] = kNoFragment;
}

TEST(SurfaceEdits, SequencesEqualRebuildsAndEditListsReproduceThem) {
  Random random(51);
  const TetMesh mesh = small_box();
  for (const SurfaceMode mode : kModes) {
    for (const std::size_t greatest_burst : {3, 30}) {
      SurfaceExtractor surface(mesh, {.mode = mode}), fresh(mesh, {.mode = mode});
      Renderer renderer;
      renderer.follow(surface);
      Body body(mesh);
      std::set<std::uint32_t> removed;
      surface.update(body.now());
      renderer.follow(surface);
      const auto order = random_order(mesh.springs.size(), random);
      for (std::size_t next = 0; next < order.size();) {
        for (std::size_t burst = 1 + random.below(greatest_burst); burst > 0 && next < order.size(); --burst) {
          body.intact[order[next++]] = 0;
        }
        remove_some(removed, body, random);
        body.time += 0.01;
        surface.update(body.now());
        ASSERT_FALSE(surface.rebuilt());
        renderer.follow(surface);
        ASSERT_TRUE(renderer.agrees(surface)) << next;
        ASSERT_TRUE(every_vertex_is_used(surface)) << next;
        ASSERT_TRUE(normals_are_flat(surface)) << next;
        fresh.rebuild(body.now());
        ASSERT_EQ(surface.positions().size(), fresh.positions().size());
        ASSERT_EQ(named_triangles(surface), named_triangles(fresh)) << next;
        surface.update(body.now());
        ASSERT_TRUE(surface.changed_triangles().empty() && surface.changed_vertices().empty()) << "nothing was cut";
      }
      EXPECT_FALSE(removed.empty());
    }
  }
}

TEST(SurfaceEdits, WhatCannotFollowIsARebuild) {
  Random random(52);
  const TetMesh mesh = small_box();
  for (const SurfaceMode mode : kModes) {
    SurfaceExtractor surface(mesh, {.mode = mode});
    EXPECT_TRUE(surface.rebuilt());
    Body body(mesh, random_flags(mesh.springs.size(), 0.9, random));
    body.time = 5;
    const auto expect_rebuild = [&] {
      surface.update(body.now());
      EXPECT_TRUE(surface.rebuilt());
      EXPECT_EQ(surface.changed_triangles().size(), surface.triangles().size());
      EXPECT_EQ(surface.changed_vertices().size(), surface.positions().size());
      SurfaceExtractor fresh(mesh, {.mode = mode});
      fresh.rebuild(body.now());
      EXPECT_EQ(named_triangles(surface), named_triangles(fresh));
      surface.update(body.now());
      EXPECT_FALSE(surface.rebuilt());
    };
    expect_rebuild();  // the first
    body.time = 4.9;
    expect_rebuild();
    *std::find(body.intact.begin(), body.intact.end(), 0) = 1;
    body.relabel();
    expect_rebuild();
    Body without = body;
    std::replace(without.labels.begin(), without.labels.end(), body.labels[7], kNoFragment);
    surface.update(without.now());
    EXPECT_FALSE(surface.rebuilt());
    expect_rebuild();  // it is back
  }
}

// Removed fragments leave nothing behind; what stays is closed round the cells of the nodes that stay.
TEST(SurfaceEdits, RemovedFragmentsAreNotDrawn) {
  Random random(53);
  const TetMesh mesh = small_box();
  for (const SurfaceMode mode : {SurfaceMode::cracks, SurfaceMode::fragments}) {
    for (const double share : {0.6, 0.75, 0.9}) {
      SurfaceExtractor surface(mesh, {.mode = mode});
      Body body(mesh);
      surface.update(body.now());
      body.intact = random_flags(mesh.springs.size(), share, random);
      body.relabel();
      surface.update(body.now());
      const std::size_t count = label_count(body.labels);
      for (std::uint32_t f = 1; f < count; f += 2) {
        std::replace(body.labels.begin(), body.labels.end(), f, kNoFragment);
      }
      for (int with_past = 1; with_past >= 0; --with_past) {
        with_past ? surface.update(body.now()) : surface.rebuild(body.now());
        EXPECT_EQ(surface.rebuilt(), with_past == 0);
        double cells = 0;
        for (std::size_t i = 0; i < body.labels.size(); ++i) {
          if (body.labels[i] != kNoFragment) cells += mesh.node_volumes[i];
        }
        EXPECT_EQ(find_surface_defects(rest_surface(surface)).total(), 0u);
        EXPECT_NEAR(volume(rest_surface(surface)), cells, 1e-12 * volume(mesh));
        EXPECT_TRUE(every_vertex_is_used(surface));
        for (const std::uint32_t f : surface.fragments()) ASSERT_NE(f, kNoFragment);
      }
      std::fill(body.labels.begin(), body.labels.end(), kNoFragment);
      surface.update(body.now());
      EXPECT_EQ(surface.triangles().size(), 0u);
      EXPECT_EQ(surface.positions().size(), 0u);
    }
  }
}

// The paper's solids touch in points and edges: every way along an edge has its way back, and the volume is theirs.
TEST(SurfaceEdits, PaperModeIsClosedAndHasTheVolumeOfItsSolids) {
  Random random(54);
  const TetMesh mesh = small_box();
  const std::map<unsigned, double> lost{{11, 0.25}, {15, 0.125}, {31, 0.25}, {63, 0.5}};  // share, by class
  SurfaceExtractor surface(mesh, {.mode = SurfaceMode::paper});
  Body body(mesh);
  const auto order = random_order(mesh.springs.size(), random);
  surface.update(body.now());
  for (std::size_t next = 0; next < order.size(); ++next) {
    body.intact[order[next]] = 0;
    if (next % 25 != 0 && next + 1 != order.size()) continue;
    body.relabel();
    surface.update(body.now());
    std::map<std::pair<std::uint32_t, std::uint32_t>, int> balance;
    for (const Triangle& n : surface.triangles()) {
      for (std::size_t k = 0; k < 3; ++k) {
        const std::uint32_t a = n[k], b = n[(k + 1) % 3];
        a < b ? ++balance[{a, b}] : --balance[{b, a}];
      }
    }
    for (const auto& [edge, sum] : balance) ASSERT_EQ(sum, 0);
    double expected = 0;
    for (std::size_t t = 0; t < mesh.tetrahedra.size(); ++t) {
      const auto [a, b, c, d] = mesh.tetrahedra[t];
      const auto& p = mesh.positions;
      const auto loss = lost.find(kCutMasks[cut_mask(mesh.tet_springs[t], body.intact)].least_mask);
      expected += orient(p[a], p[b], p[c], p[d]) / 6 * (loss == lost.end() ? 1 : 1 - loss->second);
    }
    ASSERT_NEAR(volume(rest_surface(surface)), expected, 1e-12 * volume(mesh)) << next;
    ASSERT_LE(surface.triangles().size(), surface.max_triangle_count());
    ASSERT_LE(surface.positions().size(), surface.max_vertex_count());
  }
}

// Coordinates that are linear over the body stay so on the skin's parts: given at the boundary's corners, they come out
// as the same function of the place at rest. Each boundary triangle has its own, as texture atlases do.
TEST(SurfaceEdits, SkinKeepsTheCoordinatesOfItsSource) {
  Random random(55);
  const TetMesh mesh = small_box();
  const auto coordinates = [&](std::size_t source, const Vec3& place) -> Eigen::Vector2f {
    const double shift = static_cast<double>(source % 7);
    return Eigen::Vector2d(40 * place.x() - 30 * place.z() + shift, 50 * place.y() + 20 * place.x() - shift)
        .cast<float>();
  };
  Vector<SurfaceExtractor::CornerCoordinates> given(mesh.boundary.size());
  for (std::size_t b = 0; b < given.size(); ++b) {
    for (std::size_t k = 0; k < 3; ++k) given[b][k] = coordinates(b, mesh.positions[mesh.boundary[b][k]]);
  }
  for (const SurfaceMode mode : kModes) {
    SurfaceExtractor surface(mesh, {.mode = mode});
    Body body(mesh);
    const auto order = random_order(mesh.springs.size(), random);
    for (std::size_t next = 0; next < order.size(); ++next) {
      if (next % 60 == 0) {
        body.relabel();
        surface.update(body.now());
        ASSERT_EQ(surface.skin_sources().size(), surface.skin_triangle_count());
        Vector<SurfaceExtractor::CornerCoordinates> spread(surface.skin_triangle_count());
        surface.spread_over_skin(given, spread);
        for (std::size_t t = 0; t < spread.size(); ++t) {
          const std::uint32_t source = surface.skin_sources()[t];
          for (std::size_t k = 0; k < 3; ++k) {
            const Vec3& place = surface.rest_positions()[surface.triangles()[t][k]];
            ASSERT_LT((spread[t][k] - coordinates(source, place)).norm(), 2e-6f);
            const auto& p = mesh.positions;
            const auto [a, b, c] = mesh.boundary[source];
            ASSERT_LT(std::abs(orient(p[a], p[b], p[c], place)), 1e-18);
          }
        }
      }
      body.intact[order[next]] = 0;
    }
  }
}

TEST(SurfaceEdits, SettingsAreChecked) {
  const TetMesh mesh = small_box();
  const auto refuses = [&](const SurfaceSettings& settings, Code code, const std::string& field) {
    try {
      const SurfaceExtractor surface(mesh, settings);
      ADD_FAILURE() << field;
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), code);
      EXPECT_NE(std::string(error.what()).find(field), std::string::npos) << error.what();
    }
  };
  refuses({.mode = static_cast<SurfaceMode>(3)}, Code::out_of_range, "settings.mode");
  refuses({.settle = -1e-9}, Code::out_of_range, "settings.settle");
  refuses({.settle = std::numeric_limits<double>::quiet_NaN()}, Code::invalid_value, "settings.settle");
  refuses({.crease = 3.2}, Code::out_of_range, "settings.crease");
}

}  // namespace
}  // namespace crumble
