// Nothing pops: at a cut every drawn point stays where it is, and goes to its new place in the settling time.
#include <gtest/gtest.h>

#include <map>

#include "crumble/base/memory.hpp"
#include "states.hpp"

namespace crumble {
namespace {

using namespace fracture_test;

constexpr double kSettle = 0.05;

// Stretched by 30 % and shaken: every spring is strained.
VecArray strained(const TetMesh& mesh, Random& random) {
  VecArray positions(mesh.node_count());
  for (std::size_t i = 0; i < mesh.node_count(); ++i) {
    const Vec3& p = mesh.positions[i];
    const Vec3 noise(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1));
    positions.set(i, Vec3(1.3 * p.x(), 0.9 * p.y() + 3 * p.x() * p.x(), 0.9 * p.z()) + 3e-4 * noise);
  }
  return positions;
}

TetMesh small_box() {
  return make_lattice_box({0.03, 0.03, 0.02}, 0.005);
}

// What the rotations remember of their past dies away with each look at the same body; this much, in m, may be left.
constexpr double kMemory = 1e-9;
void look_long(SurfaceExtractor& surface, const Body& body) {
  for (int i = 0; i < 20; ++i) surface.update(body.now());
}

// The picture as a map from the body at rest to space: skin triangles by source, vertices by place.
struct Picture {
  explicit Picture(const SurfaceExtractor& surface)
      : triangles(surface.triangles().begin(), surface.triangles().end()),
        sources(surface.skin_sources().begin(), surface.skin_sources().end()),
        positions(surface.positions().begin(), surface.positions().end()),
        rest(surface.rest_positions().begin(), surface.rest_positions().end()) {}

  // Where the point `place` of the skin above `source` is drawn.
  Vec3 skin_point(std::uint32_t source, const Vec3& place) const {
    for (std::size_t t = 0; t < sources.size(); ++t) {
      if (sources[t] != source) continue;
      const auto [a, b, c] = triangles[t];
      const Vec3 normal = cross(rest[b] - rest[a], rest[c] - rest[a]);
      const double whole = dot(normal, normal);
      const double u = dot(normal, cross(rest[b] - place, rest[c] - place)) / whole;
      const double v = dot(normal, cross(rest[c] - place, rest[a] - place)) / whole;
      if (u < -1e-9 || v < -1e-9 || u + v > 1 + 1e-9) continue;
      return u * positions[a] + v * positions[b] + (1 - u - v) * positions[c];
    }
    return Vec3::Constant(1e9);
  }

  Vector<Triangle> triangles;
  Vector<std::uint32_t> sources;
  Vector<Vec3> positions, rest;
};

// Greatest distance between the skin of two pictures, at points all over the later one's triangles.
double skin_jump(const Picture& before, const Picture& after) {
  double jump = 0;
  const std::array<Vec3, 4> weights{Vec3(1, 1, 1) / 3, Vec3(0.9, 0.05, 0.05), Vec3(0.05, 0.9, 0.05),
                                    Vec3(0.05, 0.05, 0.9)};
  for (std::size_t t = 0; t < after.sources.size(); ++t) {
    const auto [a, b, c] = after.triangles[t];
    for (const Vec3& w : weights) {
      const Vec3 place = w.x() * after.rest[a] + w.y() * after.rest[b] + w.z() * after.rest[c];
      const Vec3 now = w.x() * after.positions[a] + w.y() * after.positions[b] + w.z() * after.positions[c];
      jump = std::max(jump, norm(now - before.skin_point(after.sources[t], place)));
    }
  }
  return jump;
}

using Key = std::array<double, 3>;
Key key(const Vec3& p) {
  return {p.x(), p.y(), p.z()};
}

// Greatest distance of a vertex from the nearest that `before` drew for the same place at rest; from the uncut body's
// point if there was none.
double vertex_jump(const Picture& before, const Picture& after, const std::map<Key, Vec3>& uncut) {
  std::multimap<Key, Vec3> drawn;
  for (std::size_t v = 0; v < before.rest.size(); ++v) drawn.insert({key(before.rest[v]), before.positions[v]});
  double jump = 0;
  for (std::size_t v = 0; v < after.rest.size(); ++v) {
    const auto [first, last] = drawn.equal_range(key(after.rest[v]));
    double nearest = first == last ? norm(after.positions[v] - uncut.at(key(after.rest[v]))) : 1e9;
    for (auto it = first; it != last; ++it) nearest = std::min(nearest, norm(after.positions[v] - it->second));
    jump = std::max(jump, nearest);
  }
  return jump;
}

// Where the points of the uncut body are: means of the nodes they lie between.
std::map<Key, Vec3> uncut_points(const TetMesh& mesh, VecView positions) {
  std::map<Key, Vec3> points;
  for (Tetrahedron nodes : mesh.tetrahedra) {
    std::sort(nodes.begin(), nodes.end());
    for (unsigned set = 1; set < 16; ++set) {
      Vec3 rest = Vec3::Zero(), now = Vec3::Zero();
      int count = 0;
      for (std::size_t k = 0; k < 4; ++k) {
        if ((set >> k & 1u) == 0) continue;
        rest += mesh.positions[nodes[k]], now += positions[nodes[k]], ++count;
      }
      points[key(1.0 / count * rest)] = 1.0 / count * now;
    }
  }
  return points;
}

TEST(SurfaceSettle, NothingMovesAtTheMomentOfACut) {
  Random random(61);
  const TetMesh mesh = small_box();
  for (const SurfaceMode mode : {SurfaceMode::cracks, SurfaceMode::fragments}) {
    SurfaceExtractor surface(mesh, {.mode = mode, .settle = kSettle});
    Body body(mesh);
    body.positions = strained(mesh, random);
    const auto uncut = uncut_points(mesh, body.positions);
    const auto order = random_order(mesh.springs.size(), random);
    look_long(surface, body);
    std::size_t grown = 0;
    for (std::size_t next = 0; next < order.size();) {
      const Picture before(surface);
      for (std::size_t burst = 1 + random.below(60); burst > 0 && next < order.size(); --burst) {
        body.intact[order[next++]] = 0;
      }
      body.relabel();
      surface.update(body.now());
      ASSERT_FALSE(surface.rebuilt());
      const Picture after(surface);
      grown += after.positions.size() > before.positions.size();
      ASSERT_LT(skin_jump(before, after), 1e-12) << next;
      ASSERT_LT(vertex_jump(before, after, uncut), 1e-12) << next;
      body.time += 0.02;  // in the middle of the settling
      look_long(surface, body);
    }
    EXPECT_GT(grown, 10u);
  }
}

// In a body that stands still everything goes on straight lines, evenly, to where a rebuild draws it at once.
TEST(SurfaceSettle, GoesToTheSettledPlaceSteadily) {
  Random random(62);
  const TetMesh mesh = small_box();
  for (const double share : {0.02, 0.2}) {
    SurfaceExtractor surface(mesh, {.settle = kSettle}), fresh(mesh, {.settle = kSettle});
    Body body(mesh);
    body.positions = strained(mesh, random);
    body.intact = random_flags(mesh.springs.size(), share, random);
    body.relabel();
    body.time = -1;
    look_long(surface, body);
    for (std::uint8_t& flag : body.intact) flag = flag != 0 && random.uniform() > 0.1;
    body.relabel();
    body.time = 0;
    surface.update(body.now());
    const Picture cut(surface);
    look_long(surface, body);
    fresh.rebuild(body.now());
    look_long(fresh, body);
    std::map<Key, Vector<Vec3>> settled;  // copies of a site apart by nothing but their places
    for (std::size_t v = 0; v < fresh.positions().size(); ++v) {
      settled[key(fresh.rest_positions()[v])].push_back(fresh.positions()[v]);
    }
    const Picture start(surface);
    constexpr int kFrames = 20;
    Vector<Vector<Vec3>> path{start.positions};
    for (int frame = 1; frame <= kFrames + 1; ++frame) {
      body.time = frame * kSettle / kFrames;
      look_long(surface, body);
      path.emplace_back(surface.positions().begin(), surface.positions().end());
    }
    double way = 0;
    for (std::size_t v = 0; v < start.positions.size(); ++v) {
      const Vec3& goal = path.back()[v];
      ASSERT_LT(norm(path[0][v] - cut.positions[v]), 2e-5) << v;  // looking on moves nothing but by what is remembered
      const double whole = norm(goal - path[0][v]);
      way = std::max(way, whole);
      double left = whole;
      for (int frame = 1; frame <= kFrames + 1; ++frame) {
        const auto f = static_cast<std::size_t>(frame);
        const double now = norm(goal - path[f][v]);
        ASSERT_LE(now, left + kMemory) << "vertex " << v << " frame " << frame;
        ASSERT_LE(norm(path[f][v] - path[f - 1][v]), whole / kFrames + kMemory) << "vertex " << v;
        left = now;
      }
      double miss = 1e9;
      for (const Vec3& place : settled.at(key(start.rest[v]))) miss = std::min(miss, norm(place - goal));
      ASSERT_LT(miss, 1e-9) << v;
    }
    EXPECT_GT(way, 3e-4);  // something had to settle
  }
}

// Offsets are of places now: a piece that falls while it settles does not lag.
TEST(SurfaceSettle, FallingPiecesDoNotLag) {
  Random random(63);
  const TetMesh mesh = small_box();
  SurfaceExtractor still(mesh), falling(mesh);
  Body body(mesh);
  body.positions = strained(mesh, random);
  look_long(still, body);
  look_long(falling, body);
  body.intact = random_flags(mesh.springs.size(), 0.3, random);
  body.relabel();
  still.update(body.now());
  falling.update(body.now());
  for (int frame = 1; frame < 5; ++frame) {
    body.time += 0.012;
    still.update(body.now());
    Body moved = body;
    for (double& y : moved.positions.y) y -= 0.1 * frame;
    falling.update(moved.now());
    for (std::size_t v = 0; v < still.positions().size(); ++v) {
      ASSERT_LT(norm(falling.positions()[v] - still.positions()[v] + Vec3(0, 0.1 * frame, 0)), 1e-12);
    }
  }
}

TEST(SurfaceSettle, ZeroJumpsToTheSettledPlace) {
  Random random(64);
  const TetMesh mesh = small_box();
  SurfaceExtractor surface(mesh, {.settle = 0}), slow(mesh, {.settle = kSettle});
  Body body(mesh);
  body.positions = strained(mesh, random);
  look_long(surface, body);
  look_long(slow, body);
  body.intact = random_flags(mesh.springs.size(), 0.05, random);
  body.relabel();
  surface.update(body.now());
  look_long(surface, body);
  slow.update(body.now());
  double apart = 0;
  for (std::size_t v = 0; v < slow.positions().size(); ++v) {
    apart = std::max(apart, norm(slow.positions()[v] - surface.positions()[v]));
  }
  EXPECT_GT(apart, 3e-4);
  body.time = kSettle;
  look_long(slow, body);
  for (std::size_t v = 0; v < slow.positions().size(); ++v) {
    ASSERT_LT(norm(slow.positions()[v] - surface.positions()[v]), 1e-9);
  }
}

// Cut spring by spring it must end where one is drawn that was cut at once.
TEST(SurfaceSettle, EndsWhereARebuildBegins) {
  const TetMesh mesh = make_tet_mesh({{0, 0, 0}, {1, 0, 0}, {0.2, 1, 0.1}, {0.3, 0.4, 0.9}}, {{0, 1, 2, 3}});
  VecArray nodes(mesh.positions);
  for (std::size_t i = 0; i < 4; ++i) nodes.set(i, 1.3 * mesh.positions[i]);
  SurfaceExtractor stepped(mesh), fresh(mesh);
  Flags intact(6, 1);
  double time = 0;
  for (const std::size_t spring : {1, 2, 3, 4, 5, 0}) {
    intact[spring] = 0;
    stepped.update({nodes, intact, flood_labels(mesh, intact), time += 1});
    stepped.update({nodes, intact, flood_labels(mesh, intact), time += 1});
    fresh.rebuild({nodes, intact, flood_labels(mesh, intact), time});
    EXPECT_NEAR(volume(current_surface(stepped)), volume(current_surface(fresh)), 1e-12) << "after spring " << spring;
  }
}

}  // namespace
}  // namespace crumble
