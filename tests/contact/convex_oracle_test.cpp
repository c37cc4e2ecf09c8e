// Inside, nearest point and depth of the paper's tools against closed forms, libccd's MPR and FCL.
//
// Tolerances. Ours and the closed forms are each a few roundings of numbers below 0.1 m: 1e-16 m; MPR and FCL get the
// point through a pose up to 0.2 m away, work in units of the half thickness, and MPR ends when its portal is within
// 1e-9 of them. Both are held to 1e-9 half thicknesses (8 pm at most). Seen: 3e-17 m and 1e-10.
#include <gtest/gtest.h>

#include <algorithm>

#include "contact/sticks.hpp"
#include "support/oracles.hpp"

namespace crumble {
namespace {

constexpr int kPoints = 20000;
constexpr double kOurs = 1e-16;   // metres
constexpr double kTheirs = 1e-9;  // half thicknesses

double box_distance(const Vec3& p, const Vec3& size) {
  const Vec3 q = p.cwiseAbs() - size / 2;
  return norm(q.cwiseMax(0)) + std::min(q.maxCoeff(), 0.0);
}

// Regular polygon, a side's middle on -y, in the plane: fold into the half sector of one side.
double polygon_distance(double x, double y, double radius, std::uint32_t sides) {
  const double half = M_PI / sides;
  double angle = std::fmod(std::atan2(x, -y) + 4 * M_PI, 2 * half);
  if (angle > half) angle = 2 * half - angle;
  const double r = std::hypot(x, y), along = r * std::sin(angle), above = r * std::cos(angle) - radius * std::cos(half);
  const double beyond = along - radius * std::sin(half);
  return beyond > 0 ? std::hypot(above, beyond) : above;
}

double closed_form_distance(const Stick& stick, const Vec3& p) {
  if (stick.sides == 0) return box_distance(p, stick.size);
  const double radial = polygon_distance(p.x(), p.y(), stick.size.x() / 2, stick.sides);
  const double axial = std::abs(p.z()) - stick.size.z() / 2;
  return std::hypot(std::max(radial, 0.0), std::max(axial, 0.0)) + std::min(std::max(radial, axial), 0.0);
}

// All over the tool and around it, and crowded on both sides of faces, edges and corners.
Vec3 random_local_point(const Stick& stick, Random& random) {
  const Vec3 anywhere = random_vector(random).cwiseProduct(stick.size / 2);
  const TriangleMesh& mesh = stick.shape.surface;
  const auto& [a, b, c] = mesh.triangles[random.below(mesh.triangles.size())];
  const Vec3 offset = std::pow(10.0, random.uniform(-6, -2.5)) * random_direction(random);
  const double s = random.uniform(), t = random.uniform() * (1 - s);
  switch (random.below(6)) {
    case 0:
      return 0.999 * anywhere;
    case 1:
      return 1.5 * anywhere;
    case 2:
      return mesh.vertices[a] + offset;
    case 3:
      return mesh.vertices[a] + s * (mesh.vertices[b] - mesh.vertices[a]) + offset;
    default:
      return mesh.vertices[a] + s * (mesh.vertices[b] - mesh.vertices[a]) + t * (mesh.vertices[c] - mesh.vertices[a]) +
             offset;
  }
}

Vec3 inscribed_box(const Stick& stick) {
  const double across = stick.sides == 0 ? 1 : 0.69;  // of a 16-gon: cos(pi/16) / sqrt(2)
  return stick.size.cwiseProduct(Vec3(across, across, 1));
}

class ConvexOracle : public testing::TestWithParam<int> {
 protected:
  const Stick stick = paper_sticks()[GetParam()];
  Random random{static_cast<std::uint64_t>(GetParam()) + 11};
};

TEST_P(ConvexOracle, ClosedFormSignedDistance) {
  for (int i = 0; i < kPoints; ++i) {
    const Vec3 p = random_local_point(stick, random);
    const SurfaceQuery query = nearest_surface(stick.shape, p);
    ASSERT_NEAR(query.signed_distance, closed_form_distance(stick, p), kOurs) << p.transpose();
    ASSERT_NEAR(closed_form_distance(stick, query.point), 0, kOurs) << "not on the surface: " << p.transpose();
    ASSERT_NEAR(norm(p - query.point), std::abs(query.signed_distance), kOurs);
    std::uint32_t nearest = 0;
    const double greatest = greatest_plane_distance(stick.shape, p, nearest);
    ASSERT_EQ(nearest, query.plane);
    ASSERT_LE(greatest, query.signed_distance + kOurs);
    ASSERT_EQ(greatest <= 0, query.signed_distance <= 0);
    const Plane& plane = stick.shape.planes[query.plane];
    ASSERT_NEAR(dot(plane.normal, query.point), plane.offset, query.signed_distance <= 0 ? kOurs : 1) << p.transpose();
  }
}

// To the last bit, ties included: points on edges, on the axis and at the centre are as far from several faces.
TEST_P(ConvexOracle, FastSearchesEqualPlainLoops) {
  const ConvexPolyhedron& body = stick.shape;
  for (int i = 0; i < kPoints; ++i) {
    Vec3 p = random_local_point(stick, random);
    if (i % 4 == 0) p = body.vertices[random.below(body.vertices.size())];
    if (i % 4 == 1) p = Vec3(0, 0, i % 8 == 1 ? 0.0 : p.z());
    std::uint32_t expected = 0, nearest = 0;
    for (std::uint32_t f = 1; f < body.planes.size(); ++f) {
      const auto above = [&](std::uint32_t g) { return dot(body.planes[g].normal, p) - body.planes[g].offset; };
      if (above(f) > above(expected)) expected = f;
    }
    const double greatest = greatest_plane_distance(body, p, nearest);
    ASSERT_EQ(nearest, expected) << p.transpose();
    ASSERT_EQ(greatest, dot(body.planes[expected].normal, p) - body.planes[expected].offset);
    if (greatest <= 0) continue;
    double least = 1;
    for (const auto& [a, b, c] : body.surface.triangles) {
      least = std::min(least, norm(p - closest_on_triangle(p, body.vertices[a], body.vertices[b], body.vertices[c])));
    }
    ASSERT_NEAR(nearest_surface(body, p).signed_distance, least, kOurs) << p.transpose();
    ASSERT_GT(nearest_surface(body, p, 0.9 * greatest).signed_distance, 0.9 * greatest);
    ASSERT_EQ(nearest_surface(body, p, greatest).signed_distance, nearest_surface(body, p).signed_distance);
  }
}

TEST_P(ConvexOracle, MprFindsTheSameDepthAndNoShorterWayOut) {
  const double tolerance = kTheirs * stick.shape.half_thickness;
  int compared = 0, inside = 0;
  while (compared < kPoints) {
    const Pose pose = random_pose(random);
    const Frame frame(pose);
    const Vec3 p = frame.to_scene(random_local_point(stick, random));
    const SurfaceQuery query = nearest_surface(stick.shape, frame.to_local(p));
    if (std::abs(query.signed_distance) < 100 * tolerance) continue;  // MPR cannot tell the sides apart
    ++compared;
    const MprAnswer plain = mpr_penetration(stick.shape, pose, p, pose.position);
    ASSERT_EQ(plain.inside, query.signed_distance < 0) << query.signed_distance;
    if (!plain.inside) continue;
    ++inside;
    ASSERT_GT(plain.depth, -query.signed_distance - tolerance);
    ASSERT_NEAR(closed_form_distance(stick, frame.to_local(p + plain.depth * plain.direction)), 0, tolerance);

    // sent through the point towards our nearest one, MPR leaves the body exactly there
    const Vec3 way_out = rotate(frame.rotation, stick.shape.planes[query.plane].normal);
    const Vec3 surface = frame.to_scene(query.point);
    const MprAnswer there = mpr_penetration(stick.shape, pose, p, surface - 1.5 * stick.shape.half_thickness * way_out);
    ASSERT_TRUE(there.inside);
    ASSERT_NEAR(there.depth, -query.signed_distance, tolerance);
    ASSERT_LT(norm(p + there.depth * there.direction - surface), tolerance);

    // sent from anywhere else, it finds nothing shorter
    for (int k = 0; k < 4; ++k) {
      const Vec3 center = frame.to_scene(0.9 * random_vector(random).cwiseProduct(inscribed_box(stick) / 2));
      const MprAnswer other = mpr_penetration(stick.shape, pose, p, center);
      ASSERT_TRUE(other.inside);
      ASSERT_GT(other.depth, -query.signed_distance - tolerance);
    }
  }
  EXPECT_GT(inside, kPoints / 5);
  EXPECT_LT(inside, kPoints * 4 / 5);
}

TEST_P(ConvexOracle, FclFindsTheSameDistanceOnBothSides) {
  const FclSurface oracle(stick.shape);
  const double tolerance = kTheirs * stick.shape.half_thickness;
  int compared = 0;
  while (compared < kPoints) {
    const Pose pose = random_pose(random);
    const Vec3 p = Frame(pose).to_scene(random_local_point(stick, random));
    const SurfaceQuery query = nearest_surface(stick.shape, Frame(pose).to_local(p));
    if (std::abs(query.signed_distance) < oracle.least_distance()) continue;
    ++compared;
    ASSERT_NEAR(oracle.distance(pose, p), std::abs(query.signed_distance), tolerance) << query.signed_distance;
  }
}

INSTANTIATE_TEST_SUITE_P(Sticks, ConvexOracle, testing::Range(0, 4),
                         [](const auto& test) { return paper_sticks()[test.param].name; });

// The nearest point of a convex set is the one from which no corner lies on the point's side.
TEST(ClosestOnTriangle, IsOptimalForRandomAndForThinTriangles) {
  Random random(5);
  for (int i = 0; i < kPoints; ++i) {
    const double thin = i % 2 ? 1e-6 : 1;
    const Vec3 a = random_vector(random), b = a + random_vector(random), along = random.uniform(-1, 2) * (b - a);
    const Vec3 c = a + along + thin * random_vector(random), p = a + 2 * random_vector(random);
    const Vec3 q = closest_on_triangle(p, a, b, c);
    for (const Vec3& corner : {a, b, c}) ASSERT_LE(dot(p - q, corner - q), 1e-9) << "triangle " << i;
    const Vec3 normal = cross(b - a, c - a);
    const double u = dot(cross(b - q, c - q), normal), v = dot(cross(c - q, a - q), normal),
                 w = dot(cross(a - q, b - q), normal);
    const double whole = squared_norm(normal);
    ASSERT_NEAR(dot(normal, q - a), 0, 1e-14);
    ASSERT_GE(std::min({u, v, w}), -1e-9 * whole - 1e-20) << "triangle " << i;
  }
}

TEST(ClosestOnTriangle, ItsOwnPointsStay) {
  const Vec3 a(0, 0, 0), b(2, 0, 0), c(0, 3, 0);
  for (const Vec3& p : {a, b, c, Vec3(1, 0, 0), Vec3(0, 1.5, 0), Vec3(1, 1.5, 0), Vec3(0.5, 0.5, 0)}) {
    EXPECT_LT(norm(closest_on_triangle(p, a, b, c) - p), 1e-15);
  }
  EXPECT_LT(norm(closest_on_triangle({0.5, 0.5, 7}, a, b, c) - Vec3(0.5, 0.5, 0)), 1e-15);
}

}  // namespace
}  // namespace crumble
