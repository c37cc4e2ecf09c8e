// Where the surface is when the nodes have moved, and how it is shaded.
#include <gtest/gtest.h>

#include <limits>
#include <set>

#include "crumble/geometry/pose.hpp"
#include "states.hpp"

namespace crumble {
namespace {

using namespace fracture_test;

VecArray moved(const TetMesh& mesh, const Frame& frame) {
  VecArray positions(mesh.node_count());
  for (std::size_t i = 0; i < mesh.node_count(); ++i) positions.set(i, frame.to_scene(mesh.positions[i]));
  return positions;
}

// Greatest distance of a vertex from where `frame` takes its place at rest; of those in `fragment` only, if given.
double greatest_miss(const SurfaceExtractor& surface, const Frame& frame, std::int64_t fragment = -1) {
  double miss = 0;
  for (std::size_t t = 0; t < surface.triangles().size(); ++t) {
    if (fragment >= 0 && surface.fragments()[t] != fragment) continue;
    for (const std::uint32_t v : surface.triangles()[t]) {
      miss = std::max(miss, norm(surface.positions()[v] - frame.to_scene(surface.rest_positions()[v])));
    }
  }
  return miss;
}

Frame turned(double angle) {
  return Frame({{0.3, -0.2, 0.1}, axis_angle(normalized(Vec3(1, -2, 0.5)), angle)});
}

TetMesh small_box() {
  return make_lattice_box({0.03, 0.03, 0.02}, 0.005);
}

TEST(SurfaceMotion, UncutBodyIsItsBoundaryInAnyDeformation) {
  Random random(31);
  const TetMesh mesh = small_box();
  SurfaceExtractor surface(mesh);
  VecArray positions(mesh.positions);
  for (double& y : positions.y) y += random.uniform(-1e-3, 1e-3);
  Body body(mesh);
  body.positions = positions;
  surface.update(body.now());
  using Points = std::multiset<std::array<double, 3>>;
  std::multiset<Points> drawn, expected;
  const auto key = [](const Vec3& p) { return std::array{p.x(), p.y(), p.z()}; };
  for (const auto& [a, b, c] : surface.triangles()) {
    drawn.insert({key(surface.positions()[a]), key(surface.positions()[b]), key(surface.positions()[c])});
  }
  for (const auto& [a, b, c] : mesh.boundary) {
    expected.insert({key(positions[a]), key(positions[b]), key(positions[c])});
  }
  EXPECT_EQ(drawn, expected);
  EXPECT_EQ(surface.skin_triangle_count(), surface.triangles().size());
  EXPECT_EQ(find_surface_defects(current_surface(surface)).total(), 0u);
}

TEST(SurfaceMotion, RigidMotionMovesTheSurfaceRigidly) {
  Random random(32);
  const TetMesh mesh = small_box();
  for (const double share : {0.05, 0.5, 0.8, 1.0}) {
    for (const double angle : {0.4, 2.0, kPi}) {
      SurfaceExtractor surface(mesh);
      Body body(mesh, random_flags(mesh.springs.size(), share, random));
      const Frame frame = turned(angle);
      body.positions = moved(mesh, frame);
      surface.update(body.now());
      EXPECT_LT(greatest_miss(surface, frame), 1e-12) << share << " " << angle;
      EXPECT_NEAR(volume(current_surface(surface)), volume(mesh), 1e-9 * volume(mesh));
    }
  }
}

// Step by step to rubble: in a body at rest or rigidly moved no cut shows but by its new vertices.
TEST(SurfaceMotion, NothingJumpsWhenASpringIsCut) {
  Random random(33);
  const TetMesh mesh = small_box();
  for (const double angle : {0.0, 1.0}) {
    SurfaceExtractor surface(mesh);
    const Frame frame = turned(angle);
    Body body(mesh);
    body.positions = moved(mesh, frame);
    const auto order = random_order(mesh.springs.size(), random);
    for (std::size_t next = 0; next < order.size(); ++next) {
      body.intact[order[next]] = 0;
      if (next % 40 != 0 && next + 1 != order.size()) continue;
      body.relabel();
      body.time += 0.01;
      surface.update(body.now());
      ASSERT_LT(greatest_miss(surface, frame), 1e-12) << next;
    }
  }
}

// Two halves, one turned away: each half's surface turns with it, crack faces included.
TEST(SurfaceMotion, CrackFacesTurnWithTheirPiece) {
  const TetMesh mesh = small_box();
  const auto is_right = [&](std::uint32_t node) { return mesh.positions[node].x() > 0.001; };
  Body body(mesh);
  for (std::size_t s = 0; s < body.intact.size(); ++s) {
    body.intact[s] = is_right(mesh.springs[s][0]) == is_right(mesh.springs[s][1]);
  }
  body.relabel();
  const auto& labels = body.labels;
  ASSERT_EQ(label_count(labels), 2u);
  SurfaceExtractor surface(mesh);
  surface.update(body.now());
  const Frame still(Pose{}), frame = turned(1.2);
  for (std::uint32_t i = 0; i < mesh.node_count(); ++i) {
    if (is_right(i)) body.positions.set(i, frame.to_scene(mesh.positions[i]));
  }
  const std::uint32_t right = 1 - labels[0];
  ASSERT_EQ(is_right(0), false);
  for (int frames = 0; frames < 5; ++frames) surface.update(body.now());  // the old attitude is forgotten bit by bit
  EXPECT_LT(greatest_miss(surface, frame, right), 1e-9);
  EXPECT_LT(greatest_miss(surface, still, labels[0]), 1e-9);
}

TEST(SurfaceMotion, LoneNodeKeepsItsAttitude) {
  const TetMesh mesh = small_box();
  const std::uint32_t lone = 40;
  Body body(mesh);
  for (std::size_t s = 0; s < body.intact.size(); ++s) {
    body.intact[s] = mesh.springs[s][0] != lone && mesh.springs[s][1] != lone;
  }
  body.relabel();
  SurfaceExtractor surface(mesh);
  const Frame frame = turned(0.7);
  body.positions = moved(mesh, frame);
  surface.update(body.now());
  const Vec3 away(0.02, 0.01, 0);
  body.positions.set(lone, body.positions[lone] + away);
  surface.update(body.now());
  const Frame shifted({frame.origin + away, axis_angle(normalized(Vec3(1, -2, 0.5)), 0.7)});
  EXPECT_LT(greatest_miss(surface, shifted, body.labels[lone]), 1e-12);
}

TEST(SurfaceMotion, WildPositionsDoNoLastingHarm) {
  Random random(34);
  const TetMesh mesh = small_box();
  SurfaceExtractor surface(mesh);
  Body body(mesh);
  surface.update(body.now());
  body.intact = random_flags(mesh.springs.size(), 0.5, random);
  body.relabel();
  const auto all_finite = [&] {
    bool finite = true;
    for (const Vec3& p : surface.positions()) finite = finite && is_finite(p);
    for (const auto& corners : surface.corner_normals()) {
      for (const auto& n : corners) finite = finite && n.allFinite();
    }
    return finite;
  };
  body.positions = VecArray(mesh.node_count());
  surface.update(body.now());  // all nodes in one point
  EXPECT_TRUE(all_finite());
  for (std::size_t i = 0; i < mesh.node_count(); ++i) {  // turned inside out
    body.positions.set(i, -mesh.positions[i]);
  }
  surface.update(body.now());
  EXPECT_TRUE(all_finite());
  body.positions.x.assign(mesh.node_count(), std::numeric_limits<double>::quiet_NaN());
  for (std::size_t s = 0; s < body.intact.size(); s += 3) body.intact[s] = 0;  // and cut while it is nowhere
  body.relabel();
  surface.update(body.now());
  body.positions = VecArray(mesh.positions);
  surface.update(body.now());
  EXPECT_TRUE(all_finite());
}

// A mirrored body is not a turned one: its pieces keep their handedness, so each still encloses its own volume.
TEST(SurfaceMotion, MirroredNodesDoNotMirrorTheirCells) {
  const TetMesh mesh = small_box();
  SurfaceExtractor surface(mesh);
  Body body(mesh, Flags(mesh.springs.size(), 0));
  for (double& x : body.positions.x) x = -x;
  surface.update(body.now());
  EXPECT_NEAR(volume(current_surface(surface)), volume(mesh), 1e-9 * volume(mesh));
}

TEST(SurfaceMotion, BoxNormalsBreakAtItsEdges) {
  const TetMesh mesh = small_box();
  SurfaceExtractor surface(mesh);
  for (std::size_t t = 0; t < surface.triangles().size(); ++t) {
    const auto [a, b, c] = surface.triangles()[t];
    const auto& p = surface.positions();
    const Eigen::Vector3f flat = normalized(cross(p[b] - p[a], p[c] - p[a])).cast<float>();
    for (const auto& normal : surface.corner_normals()[t]) EXPECT_LT((normal - flat).norm(), 1e-6f);
  }
}

// Both triangles of a crack facet carry the normal of the four-sided facet, which a deformation bends.
TEST(SurfaceMotion, CrackFacetsAreFlat) {
  Random random(36);
  const TetMesh mesh = small_box();
  SurfaceExtractor surface(mesh);
  Body body(mesh, random_flags(mesh.springs.size(), 0.3, random));
  for (double& z : body.positions.z) z += random.uniform(-1e-3, 1e-3);
  surface.update(body.now());
  ASSERT_GT(surface.triangles().size(), surface.skin_triangle_count() + 100);
  // The two triangles of a facet share the edge from a spring's middle to the tetrahedron's center.
  using Place = std::array<double, 3>;
  const auto key = [](const Vec3& p) { return Place{p.x(), p.y(), p.z()}; };
  std::set<Place> middles, centers;
  for (const auto& [a, b] : mesh.springs) middles.insert(key((mesh.positions[a] + mesh.positions[b]) / 2));
  for (Tetrahedron n : mesh.tetrahedra) {
    std::sort(n.begin(), n.end());
    const auto& p = mesh.positions;
    centers.insert(key((p[n[0]] + p[n[1]] + p[n[2]] + p[n[3]]) / 4));
  }
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> edges;  // directed, of interior triangles
  for (std::uint32_t t = static_cast<std::uint32_t>(surface.skin_triangle_count()); t < surface.triangles().size();
       ++t) {
    const Triangle& n = surface.triangles()[t];
    for (std::size_t k = 0; k < 3; ++k) edges[{n[k], n[(k + 1) % 3]}] = t;
  }
  const auto is_at = [&](std::uint32_t v, const auto& places) {
    return places.count(key(surface.rest_positions()[v]));
  };
  const auto at = [&](std::uint32_t v) { return surface.positions()[v]; };
  std::size_t pairs = 0;
  for (const auto& [edge, one] : edges) {
    if (!is_at(edge.first, middles) || !is_at(edge.second, centers)) continue;
    const auto back = edges.find({edge.second, edge.first});
    ASSERT_TRUE(back != edges.end());
    const auto beyond = [&](std::uint32_t t) {
      const Triangle& n = surface.triangles()[t];
      return *std::find_if(n.begin(), n.end(), [&](auto v) { return v != edge.first && v != edge.second; });
    };
    const std::uint32_t a = beyond(one), c = beyond(back->second);
    ++pairs;
    const Vec3 normal = normalized(cross(at(c) - at(a), at(edge.second) - at(edge.first)));
    for (const std::uint32_t t : {one, back->second}) {
      for (const auto& n : surface.corner_normals()[t]) {
        ASSERT_LT(std::min((n - normal.cast<float>()).norm(), (n + normal.cast<float>()).norm()), 1e-5f) << t;
      }
      const auto [p, q, r] = surface.triangles()[t];  // outward
      EXPECT_GT(dot(cross(at(q) - at(p), at(r) - at(p)), surface.corner_normals()[t][0].cast<double>()), 0);
    }
  }
  EXPECT_EQ(2 * pairs, surface.triangles().size() - surface.skin_triangle_count());
}

// A double pyramid on a 16-gon: smooth round the flanks, where neighbours meet at less than 40 degrees, creased at the
// equator. By symmetry the normal at a ring node is the mean of the two flanks on its side.
TEST(SurfaceMotion, SkinIsSmoothButForCreases) {
  Random random(35);
  const double height = 1.5;
  const auto order = random_order(18, random);
  const TetMesh mesh = make_ring(16, 1, height, order);
  SurfaceExtractor surface(mesh);
  int seen = 0;
  for (std::size_t t = 0; t < surface.triangles().size(); ++t) {
    double side = 0;
    for (const std::uint32_t v : surface.triangles()[t]) side += surface.positions()[v].z();
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3& p = surface.positions()[surface.triangles()[t][k]];
      if (std::abs(p.z()) > 0.1) continue;
      // A flank facing the angle phi has the normal (h cos phi, h sin phi, cos(pi / 16)), up or down; the node lies
      // between two at pi / 16 on either side.
      const Vec3 expected = normalized(p * height + Vec3(0, 0, side > 0 ? 1 : -1));
      EXPECT_LT((surface.corner_normals()[t][k] - expected.cast<float>()).norm(), 1e-6f);
      ++seen;
    }
  }
  EXPECT_EQ(seen, 64);
}

}  // namespace
}  // namespace crumble
