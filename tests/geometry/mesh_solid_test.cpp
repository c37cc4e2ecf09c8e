// Mesh tools against all of their triangles, the winding number and FCL.
#include "crumble/geometry/mesh_solid.hpp"

#include <gtest/gtest.h>

#include "crumble/base/error.hpp"
#include "crumble/base/random.hpp"
#include "geometry/brute_force.hpp"
#include "geometry/solid_meshes.hpp"
#include "support/allocation_counter.hpp"
#include "support/oracles.hpp"

namespace crumble {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

Vec3 random_direction(Random& random) {
  for (;;) {
    const Vec3 v(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1));
    if (v.norm() > 0.1 && v.norm() < 1) return v.normalized();
  }
}

// Anywhere about the mesh; close to a face, an edge or a corner; on the surface but for rounding.
Vec3 random_point(const TriangleMesh& mesh, Random& random) {
  const std::uint64_t choice = random.below(8);
  if (choice < 4) return {random.uniform(-2.5, 2.5), random.uniform(-2.5, 2.5), random.uniform(-2.5, 2.5)};
  const Triangle& t = mesh.triangles[random.below(mesh.triangles.size())];
  const double s = choice < 6 ? random.uniform() : 0, r = choice < 7 ? random.uniform(0, 1 - s) : 0;
  const Vec3 on = mesh.vertices[t[0]] * (1 - r - s) + mesh.vertices[t[1]] * r + mesh.vertices[t[2]] * s;
  return on + std::pow(10, random.uniform(-9, -1)) * random_direction(random);
}

TEST(MeshSolid, EqualsBruteForceInRandomPoses) {
  Random random(1);
  const auto meshes = concave_meshes();
  for (const auto& [name, mesh] : meshes) {
    SCOPED_TRACE(name);
    MeshSolidReport report;
    const Solid solid = make_mesh_solid(mesh, {}, &report);
    ASSERT_FALSE(report.polyhedron);
    std::uint32_t hint = 0;
    int inside = 0;
    for (int i = 0; i < 17000; ++i) {
      const Quat turn = axis_angle(random_direction(random), random.uniform(-3, 3));
      const Pose pose{5 * random_direction(random), turn};
      const Frame frame(pose);
      const Vec3 p = frame.to_local(frame.to_scene(random_point(mesh, random)));
      const double distance = brute_force::distance(mesh, p);
      if (distance < 1e-13) continue;  // either side is right
      const double expected = brute_force::is_inside(mesh, p) ? -distance : distance;
      const SolidPoint near = solid->nearest(p, kInfinity);
      if (i % 2) hint = static_cast<std::uint32_t>(random.next());  // it must not matter
      SolidPoint found;
      ASSERT_EQ(solid->find_inside(p, hint, found), expected < 0) << p.transpose() << " at " << expected;
      ASSERT_NEAR(near.signed_distance, expected, 4e-12) << p.transpose();
      ASSERT_NEAR((p - near.point).norm(), distance, 4e-12);
      ASSERT_LT(brute_force::distance(mesh, near.point), 4e-12);
      ASSERT_NEAR(near.normal.norm(), 1, 1e-14);
      if (distance > 1e-6) {
        ASSERT_NEAR((p - near.point).dot(near.normal), expected, 1e-8 * distance);
      }
      if (expected >= 0) continue;
      ++inside;
      ASSERT_EQ(found.signed_distance, near.signed_distance);
      ASSERT_EQ(found.point, near.point);
      ASSERT_EQ(found.normal, near.normal);
    }
    EXPECT_GT(inside, 300);
  }
}

TEST(MeshSolid, NormalsOfFacesPointOutward) {
  Random random(2);
  for (const auto& [name, mesh] : concave_meshes()) {
    const Solid solid = make_mesh_solid(mesh);
    for (int i = 0; i < 1000; ++i) {
      const SolidPoint near = solid->nearest(random_point(mesh, random), kInfinity);
      if (std::abs(near.signed_distance) > 1e-3) continue;
      ASSERT_EQ(std::round(brute_force::winding(mesh, near.point + 1e-6 * near.normal)), 0) << name;
    }
  }
}

// The tip of a spike with one side cut into many triangles, whose normals must not outvote those of the other sides.
TEST(MeshSolid, NormalsAtCornersAreWeightedByAngle) {
  constexpr std::uint32_t kCuts = 30;
  TriangleMesh mesh = make_bar({1, 1, 1}).surface;  // a second part, as the spike alone is convex
  for (Vec3& v : mesh.vertices) v += Vec3(5, 0, 0);
  const auto tip = static_cast<std::uint32_t>(mesh.vertices.size()), back = tip + 1, cut = tip + 2;
  mesh.vertices.push_back({0, 0, 2});
  mesh.vertices.push_back({-0.2, 0, 0});
  for (std::uint32_t i = 0; i <= kCuts; ++i) mesh.vertices.push_back({0.2, -0.3 + 0.6 * i / kCuts, 0});
  for (std::uint32_t i = 0; i < kCuts; ++i) {
    mesh.triangles.push_back({tip, cut + i, cut + i + 1});
    mesh.triangles.push_back({back, cut + i + 1, cut + i});
  }
  mesh.triangles.push_back({tip, back, cut});
  mesh.triangles.push_back({tip, cut + kCuts, back});
  const Solid solid = make_mesh_solid(mesh);
  Random random(9);
  for (int i = 0; i < 2000; ++i) {
    const Vec3 p = mesh.vertices[tip] + 0.1 * random_direction(random);
    const double distance = brute_force::distance(mesh, p);
    ASSERT_NEAR(solid->nearest(p, 1).signed_distance, brute_force::is_inside(mesh, p) ? -distance : distance, 1e-12);
  }
}

TEST(MeshSolid, DistanceOutsideEqualsFcl) {
  Random random(3);
  for (const auto& [name, mesh] : concave_meshes()) {
    const Solid solid = make_mesh_solid(mesh);
    ConvexPolyhedron carrier;
    carrier.surface = mesh;
    carrier.half_thickness = 0.5;
    const FclSurface fcl(carrier);
    for (int i = 0; i < 2000; ++i) {
      const Vec3 p = random_point(mesh, random);
      const double distance = solid->nearest(p, kInfinity).signed_distance;
      if (distance < fcl.least_distance()) continue;
      ASSERT_NEAR(distance, fcl.distance({}, p), 1e-9) << name << " at " << p.transpose();
    }
  }
}

TEST(MeshSolid, FarPointsAreAnsweredWithMoreThanFar) {
  Random random(4);
  for (const auto& [name, mesh] : concave_meshes()) {
    const Solid solid = make_mesh_solid(mesh);
    for (int i = 0; i < 5000; ++i) {
      const Vec3 p = random_point(mesh, random);
      const double exact = solid->nearest(p, kInfinity).signed_distance, far = random.uniform(0, 0.5);
      const SolidPoint near = solid->nearest(p, far);
      if (exact > far) {
        ASSERT_GT(near.signed_distance, far) << name;
      } else {
        ASSERT_EQ(near.signed_distance, exact) << name;
      }
    }
  }
}

TEST(MeshSolid, LeavesAlongTheFirstWayOut) {
  Random random(5);
  for (const auto& [name, mesh] : concave_meshes()) {
    const Solid solid = make_mesh_solid(mesh);
    int inside = 0;
    for (int i = 0; i < 5000; ++i) {
      const Vec3 p = random_point(mesh, random), direction = random_direction(random);
      SolidPoint out, near;
      std::uint32_t hint = 0;
      if (!solid->find_inside(p, hint, near) || near.signed_distance > -1e-9) continue;
      ++inside;
      ASSERT_TRUE(solid->leave_along(p, direction, out)) << name;
      ASSERT_NEAR(-out.signed_distance, brute_force::first_exit(mesh, p, direction), 1e-9) << name;
      ASSERT_LT((out.point - (p - out.signed_distance * direction)).norm(), 1e-12);
      ASSERT_GE(out.normal.dot(direction), 0);
    }
    EXPECT_GT(inside, 100) << name;
  }
}

TEST(MeshSolid, RaysThroughEdgesAndCornersDoNotLeak) {
  for (const auto& [name, mesh] : concave_meshes()) {
    if (name == "torus" || name == "hollow box") continue;  // the origin is not inside
    const Solid solid = make_mesh_solid(mesh);
    const Vec3 p(0.01, 0.02, name == "cup" ? 0.05 : 0.03);
    for (const Triangle& t : mesh.triangles) {
      for (const Vec3& target : {mesh.vertices[t[0]], Vec3(0.5 * (mesh.vertices[t[0]] + mesh.vertices[t[1]]))}) {
        SolidPoint out;
        ASSERT_TRUE(solid->leave_along(p, (target - p).normalized(), out)) << name;
        ASSERT_LE(-out.signed_distance, (target - p).norm() + 1e-9) << name;
      }
    }
  }
}

TEST(MeshSolid, HalfThicknessIsThatOfTheWalls) {
  EXPECT_NEAR(make_mesh_solid(make_torus(1, 0.3, 48, 24))->half_thickness(), 0.3, 0.02);
  EXPECT_NEAR(make_mesh_solid(make_cup())->half_thickness(), 0.05, 0.003);
  EXPECT_NEAR(make_mesh_solid(make_hollow_box())->half_thickness(), 0.25, 1e-6);
  EXPECT_NEAR(make_mesh_solid(make_l_shape())->half_thickness(), 0.5, 0.01);
}

TEST(MeshSolid, CornersHoldIt) {
  for (const auto& [name, mesh] : concave_meshes()) {
    const Solid solid = make_mesh_solid(mesh);
    ASSERT_EQ(solid->corners().size() % 4, 0u);
    Vec3 low = solid->corners()[0], high = low;
    for (std::size_t i = 0; i < solid->corners().size(); ++i) {
      low = low.cwiseMin(solid->corners()[i]), high = high.cwiseMax(solid->corners()[i]);
    }
    for (const Vec3& v : mesh.vertices) {
      ASSERT_TRUE((v.array() >= low.array()).all() && (v.array() <= high.array()).all()) << name;
    }
    EXPECT_EQ(solid->rounding(), 0);
  }
}

TEST(MeshSolid, ConvexMeshesBecomePolyhedraAndFineOnesStayMeshes) {
  MeshSolidReport report;
  const ConvexPolyhedron stick = make_round_stick(0.004, 0.05, 16);
  const Solid solid = make_mesh_solid(stick.surface, {}, &report);
  EXPECT_TRUE(report.polyhedron);
  EXPECT_EQ(solid->half_thickness(), stick.half_thickness);
  const TriangleMesh ball = make_blob(4, 0, 1);  // 5120 triangles
  const Solid fine = make_mesh_solid(ball, {}, &report);
  EXPECT_FALSE(report.polyhedron);
  const ConvexPolyhedron planes = make_convex(ball);
  Random random(6);
  for (int i = 0; i < 2000; ++i) {
    const Vec3 p = random_point(ball, random);
    ASSERT_NEAR(fine->nearest(p, kInfinity).signed_distance, nearest_surface(planes, p).signed_distance, 1e-12);
  }
}

TEST(MeshSolid, QueriesAllocateNothing) {
  if (!AllocationCounter::available()) GTEST_SKIP() << "nothing counts here";
  Random random(7);
  const TriangleMesh mesh = make_cup();
  const Solid solid = make_mesh_solid(mesh);
  const AllocationCounter counter;
  std::uint32_t hint = 0;
  for (int i = 0; i < 1000; ++i) {
    const Vec3 p = random_point(mesh, random);
    SolidPoint out;
    solid->find_inside(p, hint, out);
    solid->nearest(p, 0.1);
    solid->leave_along(p, Vec3::UnitX(), out);
  }
  EXPECT_EQ(counter.count(), 0u);
}

TEST(MeshSolid, PointsThatAreNoNumbersAreOutside) {
  const Solid solid = make_mesh_solid(make_l_shape());
  std::uint32_t hint = 0;
  SolidPoint out;
  for (const double bad : {std::nan(""), kInfinity, -kInfinity, 1e300}) {
    for (int axis = 0; axis < 3; ++axis) {
      Vec3 p(0, 0, 0);
      p[axis] = bad;
      EXPECT_FALSE(solid->find_inside(p, hint, out));
      solid->nearest(p, 1);
      solid->leave_along(p, Vec3::UnitX(), out);
    }
  }
}

TEST(MeshSolid, ComesBackFromBytesWithTheSameAnswers) {
  Random random(8);
  for (const auto& [name, mesh] : concave_meshes()) {
    const Solid solid = make_mesh_solid(mesh);
    ByteWriter out;
    solid->write(out);
    ByteReader in(out.bytes(), "test");
    const Solid again = read_solid(in);
    EXPECT_EQ(in.left(), 0u);
    EXPECT_EQ(again->half_thickness(), solid->half_thickness());
    for (int i = 0; i < 200; ++i) {
      const Vec3 p = random_point(mesh, random);
      ASSERT_EQ(again->nearest(p, kInfinity).point, solid->nearest(p, kInfinity).point) << name;
    }
  }
}

// A recording knows its definition by these bytes.
TEST(MeshSolid, TurnedInsideOutItIsReadBackWithTheSameBytes) {
  for (auto [name, mesh] : concave_meshes()) {
    for (Triangle& t : mesh.triangles) std::swap(t[1], t[2]);
    ByteWriter first, second;
    make_mesh_solid(mesh, {.auto_orient = true})->write(first);
    ByteReader in(first.bytes(), "test");
    read_solid(in)->write(second);
    EXPECT_EQ(first.bytes(), second.bytes()) << name;
  }
}

}  // namespace
}  // namespace crumble
