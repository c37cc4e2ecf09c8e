// Meshes that cannot be tools: a clear error for each, and never an answer that brute force contradicts.
#include <gtest/gtest.h>

#include <functional>

#include "crumble/base/error.hpp"
#include "crumble/base/random.hpp"
#include "crumble/geometry/mesh_solid.hpp"
#include "geometry/brute_force.hpp"
#include "geometry/solid_meshes.hpp"

namespace crumble {
namespace {

struct Refusal {
  Code code{0};
  std::string text;
};

Refusal refusal_of(const TriangleMesh& mesh, const MeshSolidOptions& options = {}) {
  try {
    make_mesh_solid(mesh, options);
  } catch (const Error& error) {
    return {error.code(), error.what()};
  }
  return {};
}

TriangleMesh damaged(const std::function<void(TriangleMesh&)>& damage) {
  TriangleMesh mesh = make_torus(1, 0.3, 12, 6);  // 72 vertices, 144 triangles
  damage(mesh);
  return mesh;
}

#define EXPECT_REFUSED(mesh, expected_code, words)                          \
  do {                                                                      \
    const Refusal refusal = refusal_of(mesh);                               \
    EXPECT_EQ(refusal.code, expected_code) << refusal.text;                 \
    EXPECT_NE(refusal.text.find(words), std::string::npos) << refusal.text; \
  } while (false)

void append(TriangleMesh& mesh, const TriangleMesh& other, const Vec3& offset, double scale = 1) {
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  for (const Vec3& v : other.vertices) mesh.vertices.push_back(scale * v + offset);
  for (const auto& [a, b, c] : other.triangles) mesh.triangles.push_back({a + first, b + first, c + first});
}

void flip(TriangleMesh& mesh) {
  for (Triangle& t : mesh.triangles) std::swap(t[1], t[2]);
}

TEST(BadMesh, NumbersAreNamed) {
  EXPECT_EQ(refusal_of(damaged([](auto&) {})).code, Code{0});
  EXPECT_REFUSED(TriangleMesh{}, Code::empty, "no triangles");
  EXPECT_REFUSED(damaged([](auto& m) { m.triangles.resize(3); }), Code::mesh, "has 3 triangles");
  EXPECT_REFUSED(damaged([](auto& m) { m.triangles[7][1] = 72; }), Code::mesh, "triangle 7 names vertex 72 of 72");
  EXPECT_REFUSED(damaged([](auto& m) { m.vertices[5].y() = std::nan(""); }), Code::mesh, "vertex 5 is not finite");
  EXPECT_REFUSED(damaged([](auto& m) { m.vertices[5].x() = -std::numeric_limits<double>::infinity(); }), Code::mesh,
                 "vertex 5 is not finite");
  EXPECT_REFUSED(damaged([](auto& m) { m.vertices[6].z() = -1001; }), Code::out_of_range,
                 "vertex 6 has the coordinate -1001 m");
}

TEST(BadMesh, SizesAreNamed) {
  EXPECT_REFUSED(damaged([](auto& m) { m.triangles.resize(kMaxSolidTriangles + 1); }), Code::too_large, "2000001");
  EXPECT_REFUSED(damaged([](auto& m) {
                   for (Vec3& v : m.vertices) v *= 1e-7;
                 }),
                 Code::out_of_range, "across");
  EXPECT_REFUSED(damaged([](auto& m) {
                   for (Vec3& v : m.vertices) v = Vec3::Zero();
                 }),
                 Code::out_of_range, "0 m across");
  EXPECT_REFUSED(damaged([](auto& m) {
                   for (Vec3& v : m.vertices) v.z() = 0;
                 }),
                 Code::mesh, "flat");
  EXPECT_REFUSED(damaged([](auto& m) {
                   for (int i = 0; i < 256; ++i) append(m, make_bar({1, 1, 1}).surface, {3.0 + 2 * i, 0, 0});
                 }),
                 Code::too_large, "257 parts");
}

TEST(BadMesh, HolesAndEdgesAreNamed) {
  EXPECT_REFUSED(damaged([](auto& m) { m.triangles.erase(m.triangles.begin() + 9); }), Code::mesh_open, "is open");
  EXPECT_REFUSED(damaged([](auto& m) { std::swap(m.triangles[9][0], m.triangles[9][1]); }), Code::mesh_orientation,
                 "runs the same way");
  EXPECT_REFUSED(damaged([](auto& m) { m.triangles.push_back(m.triangles[9]); }), Code::mesh,
                 "joins more than two triangles");
  // two boxes that share the corners of an edge: four triangles on it
  TriangleMesh boxes = make_bar({1, 1, 1}).surface;
  append(boxes, make_bar({1, 1, 1}).surface, {1, 1, 0});
  for (Triangle& t : boxes.triangles) {
    for (std::uint32_t& v : t) v = v == 8 ? 3 : v == 12 ? 7 : v;
  }
  EXPECT_REFUSED(boxes, Code::mesh, "more than two triangles");
  TriangleMesh tips = make_bar({1, 1, 1}).surface;  // two boxes that share one corner
  append(tips, make_bar({1, 1, 1}).surface, {1, 1, 1});
  for (Triangle& t : tips.triangles) {
    for (std::uint32_t& v : t) v = v == 8 ? 7 : v;
  }
  EXPECT_REFUSED(tips, Code::mesh, "share no edge");
}

TEST(BadMesh, InsideOutIsRefusedOrTurned) {
  TriangleMesh mesh = make_l_shape();
  flip(mesh);
  EXPECT_REFUSED(mesh, Code::mesh_orientation, "faces inward");
  MeshSolidReport report;
  const Solid solid = make_mesh_solid(mesh, {.auto_orient = true}, &report);
  EXPECT_TRUE(report.flipped);
  EXPECT_NEAR(volume(solid->surface()), volume(make_l_shape()), 1e-14);
  EXPECT_LT(solid->nearest(Vec3::Zero(), 1).signed_distance, -0.49);
  TriangleMesh apart = make_l_shape(), part = make_bar({1, 1, 1}).surface;  // one of two
  flip(part);
  append(apart, part, {5, 0, 0});
  EXPECT_REFUSED(apart, Code::mesh_orientation, "inside out");
}

TEST(BadMesh, PartsMustBeApartOrCavities) {
  TriangleMesh mesh = make_bar({4, 4, 4}).surface;
  append(mesh, make_bar({1, 1, 1}).surface, {0, 0, 0});
  EXPECT_REFUSED(mesh, Code::mesh, "lies in the inside of another");
  TriangleMesh two = make_bar({1, 1, 1}).surface;
  append(two, make_bar({1, 1, 1}).surface, {3, 0, 0});
  EXPECT_EQ(refusal_of(two).code, Code{0});
  EXPECT_EQ(refusal_of(make_hollow_box()).code, Code{0});
}

TEST(BadMesh, SurfacesThatCrossAreNamed) {
  TriangleMesh mesh = make_bar({2, 2, 2}).surface;
  append(mesh, make_bar({2, 2, 2}).surface, {1, 0.3, 0.2});
  EXPECT_REFUSED(mesh, Code::mesh, "run through each other");
  TriangleMesh flush = make_bar({2, 2, 2}).surface;  // they share a face, which would lie inside
  append(flush, make_bar({2, 2, 2}).surface, {2, 0, 0});
  EXPECT_REFUSED(flush, Code::mesh, "run through each other");
  EXPECT_REFUSED(damaged([](auto& m) { m.vertices[8] = -m.vertices[8]; }), Code::mesh, "run through each other");
  TriangleMesh needle = make_bar({2, 2, 2}).surface;  // its tip goes through the middle of a face
  append(needle, make_bar({0.01, 0.01, 3}).surface, {0.4, 0.1, 2});
  EXPECT_REFUSED(needle, Code::mesh, "run through each other");
  TriangleMesh close = make_bar({2, 2, 2}).surface;  // a gap of 1e-8
  append(close, make_bar({2, 2, 2}).surface, {2 + 1e-8, 0.3, 0.2});
  EXPECT_EQ(refusal_of(close).code, Code{0});
}

TEST(BadMesh, TrianglesWithoutAreaAreDroppedUnlessTheyCloseTheMesh) {
  TriangleMesh mesh = make_l_shape();
  mesh.triangles.push_back({0, 0, 1});
  mesh.triangles.insert(mesh.triangles.begin(), {3, 3, 3});
  mesh.vertices.push_back({50, 50, 50});  // that no triangle uses
  MeshSolidReport report;
  const Solid solid = make_mesh_solid(mesh, {}, &report);
  EXPECT_EQ(report.dropped_triangles, 2u);
  EXPECT_EQ(solid->surface().triangles.size(), make_l_shape().triangles.size());
  EXPECT_EQ(solid->surface().vertices.size(), make_l_shape().vertices.size());
  // a vertex in the middle of an edge of one of its triangles, with a sliver to close it
  TriangleMesh sliver = make_bar({1, 1, 1}).surface;
  const auto [a, b, c] = sliver.triangles[0];
  sliver.vertices.push_back(0.5 * (sliver.vertices[a] + sliver.vertices[b]));
  sliver.triangles[0] = {a, 8, c};
  sliver.triangles.push_back({8, b, c});
  sliver.triangles.push_back({a, b, 8});
  EXPECT_REFUSED(sliver, Code::mesh_open, "without area are left out");
}

void corrupt(TriangleMesh& mesh, Random& random) {
  const auto triangle = [&]() -> Triangle& { return mesh.triangles[random.below(mesh.triangles.size())]; };
  const auto vertex = [&]() -> Vec3& { return mesh.vertices[random.below(mesh.vertices.size())]; };
  const auto any_vertex = [&] { return static_cast<std::uint32_t>(random.below(mesh.vertices.size() + 1)); };
  constexpr double kValues[] = {0, -0.0, 1e-300, 1e300, 1e-12, 999, std::numeric_limits<double>::infinity(), NAN};
  switch (random.below(9)) {
    case 0:
      vertex() += std::pow(10, random.uniform(-12, 0.5)) * Vec3(random.uniform(-1, 1), random.uniform(-1, 1), 1);
      break;
    case 1:
      vertex()[static_cast<int>(random.below(3))] = kValues[random.below(8)];
      break;
    case 2:
      triangle()[random.below(3)] = any_vertex();
      break;
    case 3:
      std::swap(triangle()[0], triangle()[1]);
      break;
    case 4:
      mesh.triangles.erase(mesh.triangles.begin() + static_cast<long>(random.below(mesh.triangles.size())));
      break;
    case 5:
      mesh.triangles.push_back(triangle());
      break;
    case 6:
      vertex() = Vec3(vertex());
      break;
    case 7:
      mesh.triangles.push_back({any_vertex(), any_vertex(), any_vertex()});
      break;
    default:
      for (Vec3& v : mesh.vertices) v *= std::pow(10, random.uniform(-0.01, 0.01));
  }
}

TEST(BadMesh, RandomDamageIsRefusedOrHarmless) {
  Random random(1);
  const TriangleMesh good = make_torus(1, 0.3, 8, 5);
  int refused = 0, made = 0;
  for (int i = 0; i < 3000; ++i) {
    TriangleMesh mesh = good;
    for (std::uint64_t times = 1 + random.below(2); times > 0; --times) corrupt(mesh, random);
    Solid solid;
    try {
      solid = make_mesh_solid(mesh);
      ++made;
    } catch (const Error& error) {
      ASSERT_GT(std::string(error.what()).size(), 10u);
      ++refused;
      continue;
    }
    for (int k = 0; k < 20; ++k) {
      const Vec3 p(random.uniform(-1.4, 1.4), random.uniform(-1.4, 1.4), random.uniform(-0.4, 0.4));
      const double distance = brute_force::distance(solid->surface(), p);
      const double expected = brute_force::is_inside(mesh, p) ? -distance : distance;
      ASSERT_NEAR(solid->nearest(p, 1e9).signed_distance, expected, 1e-9) << i;
    }
  }
  EXPECT_GT(refused, 500);
  EXPECT_GT(made, 300);
}

}  // namespace
}  // namespace crumble
