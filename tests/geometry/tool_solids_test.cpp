// Ball, capsule, cone and blade against brute force: the least of all distances from points of the surface, searched.
// Poses of up to 0.2 m take the points to the scene and back.
//
// Tolerances: closed forms of a few roundings of numbers below 0.3 m are good to 1e-16 m, through a pose to 2e-16 m;
// the brute force ends when its points lie 1e-13 of the profile apart, so its distance is at most that much too long.
#include "crumble/geometry/tool_solids.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "crumble/base/error.hpp"
#include "crumble/base/memory.hpp"
#include "crumble/base/random.hpp"
#include "support/long_lane.hpp"

namespace crumble {
namespace {

const int kPoints = in_long_lane(100'000);
constexpr double kExact = 1e-15;

struct Flat {
  double r, z;
};

// A solid of revolution about Z by its profile: what is asked of it here is worked out in the half plane (r, z).
struct RoundSolid {
  const char* name;
  Solid solid;
  std::function<Flat(double)> profile;      // s in [0, 1]: from the axis to the axis
  std::function<bool(double, double)> has;  // whether (r, z) lies inside
  double half_thickness;
  double reach;          // radius of a ball about the origin that holds it
  Vector<double> bends;  // s where its smooth parts begin and end
};

RoundSolid capsule(const char* name, double radius, double length) {
  const double half = length / 2, quarter = M_PI / 2 * radius, all = 2 * quarter + length;
  return {name,
          length == 0 ? make_ball(radius) : make_capsule(radius, length),
          [=](double s) -> Flat {
            const double way = s * all;
            if (way < quarter) return {radius * std::sin(way / radius), -half - radius * std::cos(way / radius)};
            if (way < quarter + length) return {radius, way - quarter - half};
            const double angle = (all - way) / radius;
            return {radius * std::sin(angle), half + radius * std::cos(angle)};
          },
          [=](double r, double z) { return std::hypot(r, std::max(std::abs(z) - half, 0.0)) < radius; },
          radius,
          half + radius,
          {0, quarter / all, (quarter + length) / all, 1}};
}

RoundSolid cone(const char* name, double radius, double height) {
  const double slant = std::hypot(radius, height), share = slant / (slant + radius);
  return {name,
          make_cone(radius, height),
          [=](double s) -> Flat {
            if (s < share) return {radius * s / share, height * (s / share) - height / 2};
            return {radius * (1 - s) / (1 - share), height / 2};
          },
          [=](double r, double z) { return z < height / 2 && r * height < radius * (z + height / 2); },
          radius* height / (radius + slant),
          std::hypot(radius, height / 2),
          {0, share, 1}};
}

Vector<RoundSolid> round_solids() {
  Vector<RoundSolid> all;
  all.push_back(capsule("ball", 0.004, 0));
  all.push_back(capsule("capsule", 0.003, 0.04));
  all.push_back(capsule("thin capsule", 0.0005, 0.1));
  all.push_back(cone("cone", 0.01, 0.02));
  all.push_back(cone("needle", 0.001, 0.04));
  all.push_back(cone("flat cone", 0.03, 0.004));
  return all;
}

// Distance of (r, z) from the profile: each smooth part of it is a line or an arc of at most a quarter turn, along
// which the distance has one least place; eleven points of a part, then eleven between the neighbors of the best, and
// so on.
double brute_distance(const RoundSolid& body, double r, double z) {
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t part = 0; part + 1 < body.bends.size(); ++part) {
    double low = body.bends[part], high = body.bends[part + 1];
    while (high - low > 1e-13) {
      double best = std::numeric_limits<double>::infinity(), where = low;
      for (int i = 0; i <= 10; ++i) {
        const double s = low + (high - low) * i / 10;
        const Flat f = body.profile(s);
        const double d = std::hypot(f.r - r, f.z - z);
        if (d < best) best = d, where = s;
      }
      least = std::min(least, best);
      const double spacing = (high - low) / 10;
      low = std::max(where - spacing, low), high = std::min(where + spacing, high);
    }
  }
  return least;
}

Vec3 random_vector(Random& random, double size) {
  const double x = random.uniform(-size, size), y = random.uniform(-size, size);
  return {x, y, random.uniform(-size, size)};
}

Pose random_pose(Random& random) {
  Pose pose;
  pose.position = random_vector(random, 0.2);
  Vec3 axis = random_vector(random, 1);
  while (norm(axis) < 0.1) axis = random_vector(random, 1);
  pose.orientation = axis_angle(normalized(axis), random.uniform(-3, 3));
  return pose;
}

// All over the solid and around it, crowded on both sides of the surface, and on the axis.
Vec3 random_point(const RoundSolid& body, Random& random) {
  const auto kind = random.below(4);
  if (kind == 0) return random_vector(random, 1.5 * body.reach);
  if (kind == 1 && random.below(50) == 0) return {0, 0, random.uniform(-1.2, 1.2) * body.reach};
  const Flat f = body.profile(random.uniform());
  const double angle = random.uniform(0, 2 * M_PI), near = std::pow(10.0, random.uniform(-8, -2.5));
  const Vec3 on(f.r * std::cos(angle), f.r * std::sin(angle), f.z);
  if (kind == 1) return random.uniform() * on;  // inside: the solids are star-shaped about the origin
  return on + random_vector(random, near);
}

TEST(RoundSolids, EqualABruteForceSearchFromRandomPoses) {
  for (const RoundSolid& body : round_solids()) {
    SCOPED_TRACE(body.name);
    Random random(7);
    std::uint32_t hint = 0;
    int inside_count = 0;
    for (int i = 0; i < kPoints; ++i) {
      const Frame frame(random_pose(random));
      const Vec3 wanted = random_point(body, random), p = frame.to_local(frame.to_scene(wanted));
      ASSERT_NEAR(norm(p - wanted), 0, kExact);
      const double r = std::hypot(p.x(), p.y());
      const double brute = brute_distance(body, r, p.z());
      const SolidPoint nearest = body.solid->nearest(p, 1);
      ASSERT_LE(std::abs(nearest.signed_distance), brute + kExact) << p.transpose();
      ASSERT_GE(std::abs(nearest.signed_distance), brute - 2e-13 * body.reach - kExact) << p.transpose();
      ASSERT_TRUE(brute <= 1e-12 || (nearest.signed_distance < 0) == body.has(r, p.z())) << p.transpose();
      ASSERT_NEAR(norm(nearest.point - p), std::abs(nearest.signed_distance), kExact) << p.transpose();
      ASSERT_NEAR(norm(nearest.normal), 1, 1e-15);
      ASSERT_NEAR(brute_distance(body, std::hypot(nearest.point.x(), nearest.point.y()), nearest.point.z()), 0,
                  1e-13 * body.reach + kExact);
      // outward, and on the way from the point to its place on the surface
      ASSERT_NEAR(norm(p + std::abs(nearest.signed_distance) * nearest.normal - nearest.point), 0,
                  nearest.signed_distance < 0 ? kExact : 2 * nearest.signed_distance + kExact);
      ASSERT_FALSE(body.has(0, 0) && dot(nearest.normal, nearest.point) < -1e-15);
      SolidPoint found;
      ASSERT_EQ(body.solid->find_inside(p, hint, found), nearest.signed_distance < 0) << p.transpose();
      if (nearest.signed_distance >= 0) continue;
      ++inside_count;
      ASSERT_EQ(found.point, nearest.point);
      ASSERT_EQ(found.normal, nearest.normal);
      ASSERT_EQ(found.signed_distance, nearest.signed_distance);
    }
    EXPECT_GT(inside_count, kPoints / 5);
  }
}

// Out to the surface, nothing but inside on the way, and the normal looks out.
TEST(RoundSolids, AreLeftAlongAnyDirectionFromInside) {
  for (const RoundSolid& body : round_solids()) {
    SCOPED_TRACE(body.name);
    Random random(11);
    for (int i = 0; i < kPoints; ++i) {
      const Vec3 p = random_point(body, random);
      if (body.solid->nearest(p, 1).signed_distance > -1e-9) continue;
      Vec3 direction = random_vector(random, 1);
      if (i % 16 == 0) direction = Vec3(0, 0, i % 32 == 0 ? 1 : -1);
      if (i % 16 == 1) direction = Vec3(direction.x(), direction.y(), 0);
      direction = normalized(direction);
      SolidPoint out;
      ASSERT_TRUE(body.solid->leave_along(p, direction, out));
      ASSERT_LT(out.signed_distance, 0);
      ASSERT_NEAR(norm(p - out.signed_distance * direction - out.point), 0, kExact);
      const SolidPoint there = body.solid->nearest(out.point, 1);
      ASSERT_NEAR(there.signed_distance, 0, 1e-14) << p.transpose() << " along " << direction.transpose();
      ASSERT_GT(dot(out.normal, direction), -1e-9);
      ASSERT_NEAR(norm(out.normal), 1, 1e-15);
      for (const double share : {0.1, 0.5, 0.9}) {
        ASSERT_LT(body.solid->nearest(p - share * out.signed_distance * direction, 1).signed_distance, 1e-15);
      }
    }
    SolidPoint out;
    EXPECT_FALSE(body.solid->leave_along(Vec3::Zero(), Vec3::Zero(), out));
  }
}

TEST(RoundSolids, OnTheAxisAnswerOneOfTheNearestPoints) {
  const Solid ball = make_ball(0.01);
  SolidPoint nearest;
  std::uint32_t hint = 0;
  ASSERT_TRUE(ball->find_inside(Vec3::Zero(), hint, nearest));
  EXPECT_EQ(nearest.point, Vec3(0.01, 0, 0));
  EXPECT_EQ(nearest.normal, Vec3::UnitX());
  EXPECT_EQ(nearest.signed_distance, -0.01);
  const SolidPoint below = make_cone(0.01, 0.02)->nearest({0, 0, -0.013}, 1);
  EXPECT_EQ(below.normal, Vec3(0, 0, -1));
  EXPECT_NEAR(below.signed_distance, 0.003, 1e-17);
  EXPECT_EQ(below.point, Vec3(0, 0, -0.01));
}

TEST(RoundSolids, TakeNoNumberForOutside) {
  const double nan = std::nan("");
  for (const RoundSolid& body : round_solids()) {
    std::uint32_t hint = 0;
    SolidPoint nearest;
    EXPECT_FALSE(body.solid->find_inside({nan, 0, 0}, hint, nearest)) << body.name;
    EXPECT_FALSE(body.solid->find_inside({0, 0, nan}, hint, nearest)) << body.name;
  }
}

TEST(RoundSolids, HaveAClosedSurfaceWithItsVerticesOnThem) {
  for (const RoundSolid& body : round_solids()) {
    SCOPED_TRACE(body.name);
    const TriangleMesh& surface = body.solid->surface();
    EXPECT_EQ(find_surface_defects(surface).total(), 0u);
    double exact = 0;  // Pappus: the area under the profile turns about the axis
    constexpr int kParts = 200'000;
    for (int i = 0; i < kParts; ++i) {
      const Flat a = body.profile(double(i) / kParts), b = body.profile(double(i + 1) / kParts);
      exact += M_PI * (b.z - a.z) * (a.r * a.r + a.r * b.r + b.r * b.r) / 3;
    }
    EXPECT_GT(volume(surface), 0.95 * exact);
    EXPECT_LT(volume(surface), exact);
    for (const Vec3& v : surface.vertices) EXPECT_NEAR(body.solid->nearest(v, 1).signed_distance, 0, 1e-16);
  }
}

// Contact looks no farther than corners and rounding.
TEST(RoundSolids, LieWithinTheirCorners) {
  Random random(3);
  for (const RoundSolid& body : round_solids()) {
    SCOPED_TRACE(body.name);
    EXPECT_NEAR(body.solid->half_thickness(), body.half_thickness, 1e-18);
    EXPECT_EQ(body.solid->corners().size() % 4, 0u);
    for (int i = 0; i < 2000; ++i) {
      const Vec3 direction = normalized(random_vector(random, 1) + Vec3(1e-9, 0, 0));
      double corners = -1, points = -1;
      for (std::size_t c = 0; c < body.solid->corners().size(); ++c) {
        corners = std::max(corners, dot(direction, body.solid->corners()[c]));
      }
      for (int k = 0; k <= 200; ++k) {
        const Flat f = body.profile(k / 200.0);
        points = std::max(points, f.r * std::hypot(direction.x(), direction.y()) + f.z * direction.z());
      }
      ASSERT_GE(corners + body.solid->rounding(), points - 1e-16);
    }
  }
}

// The greatest ball inside the solid, about a point of its axis: a step of half_thickness() cannot carry the solid over
// what its middle passes.
TEST(RoundSolids, AreAsThickAsTheGreatestBallInside) {
  for (const RoundSolid& body : round_solids()) {
    double greatest = 0;
    for (int i = 0; i <= 20000; ++i) {
      const double z = body.reach * (i / 10000.0 - 1);
      greatest = std::max(greatest, -body.solid->nearest({0, 0, z}, 1).signed_distance);
    }
    EXPECT_NEAR(greatest, body.half_thickness, 2e-4 * body.reach) << body.name;
  }
}

// A ball in a point or edge of half angle a touches its sides when it is r / sin(a) away from it; in the end of an
// edge, three faces.
TEST(Solids, TellHowSharpTheyAre) {
  EXPECT_EQ(make_ball(0.01)->edge_sine(), 1);
  EXPECT_EQ(make_capsule(0.001, 0.01)->edge_sine(), 1);
  for (const double radius : {0.001, 0.01}) {
    const Solid cone = make_cone(radius, 0.02);
    EXPECT_NEAR(cone->edge_sine(), -cone->nearest({0, 0, 0.001 - 0.01}, 1).signed_distance / 0.001, 1e-12);
  }
  const Solid disk = make_cone(0.02, 0.004);
  const double half_angle = 0.5 * std::atan(0.004 / 0.02), away = 0.0001;
  const Vec3 in_rim(0.02 - away * std::cos(half_angle), 0, 0.002 - away * std::sin(half_angle));
  EXPECT_NEAR(disk->edge_sine(), -disk->nearest(in_rim, 1).signed_distance / away, 1e-12);
  EXPECT_NEAR(Solid(make_bar({0.003, 0.01, 0.05}))->edge_sine(), std::sqrt(1.0 / 3), 0.01);
  for (const std::uint32_t sides : {4u, 6u, 16u, 64u}) {
    EXPECT_GT(Solid(make_round_stick(0.004, 0.05, sides))->edge_sine(), 0.51) << sides;
  }
  for (const double bevel : {0.001, 0.004, 0.01}) {
    const double sine = 0.001 / std::hypot(0.001, bevel);
    EXPECT_NEAR(Solid(make_blade({0.002, 0.01, 0.05}, bevel))->edge_sine(), sine / std::hypot(1, sine), 0.01) << bevel;
  }
}

TEST(Solids, AreReadBackAsTheyWere) {
  Random random(5);
  for (const RoundSolid& body : round_solids()) {
    ByteWriter out;
    body.solid->write(out);
    ByteReader in(out.bytes(), "test");
    const Solid again = read_solid(in);
    EXPECT_EQ(in.left(), 0u);
    for (int i = 0; i < 100; ++i) {
      const Vec3 p = random_point(body, random);
      EXPECT_EQ(again->nearest(p, 1).point, body.solid->nearest(p, 1).point) << body.name;
    }
  }
}

TEST(Blade, IsAKnifeWithItsEdgeDown) {
  const ConvexPolyhedron knife = make_blade({0.002, 0.02, 0.05}, 0.004);
  EXPECT_EQ(knife.planes.size(), 7u);
  EXPECT_NEAR(volume(knife.surface), 0.05 * 0.002 * (0.016 + 0.004 / 2), 1e-18);
  EXPECT_EQ(find_surface_defects(knife.surface).total(), 0u);
  const Solid solid(knife);
  EXPECT_NEAR(solid->nearest({0, -0.013, 0}, 1).signed_distance, 0.003, 1e-16);  // below the edge
  EXPECT_LT(solid->nearest({0, -0.0099, 0.02}, 1).signed_distance, 0);           // just above it
  EXPECT_GT(solid->nearest({0.0005, -0.0099, 0.02}, 1).signed_distance, 0);      // the edge is sharp
  EXPECT_NEAR(solid->nearest({0.003, 0.005, 0}, 1).signed_distance, 0.002, 1e-16);
  EXPECT_EQ(make_blade({0.002, 0.02, 0.05}, 0.02).planes.size(), 5u);  // a wedge
}

void expect_refused(Code code, const char* message, const std::function<void()>& make) {
  try {
    make();
    ADD_FAILURE() << "made: " << message;
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), code) << error.what();
    EXPECT_NE(std::string(error.what()).find(message), std::string::npos) << error.what();
  }
}

TEST(Solids, RefuseSizesThatAreNone) {
  const double nan = std::nan(""), infinite = std::numeric_limits<double>::infinity();
  expect_refused(Code::out_of_range, "radius must be positive, is 0", [] { make_ball(0); });
  expect_refused(Code::out_of_range, "radius must be positive, is -1", [] { make_capsule(-1, 1); });
  expect_refused(Code::out_of_range, "length", [] { make_capsule(1, -1); });
  expect_refused(Code::invalid_value, "length", [=] { make_capsule(1, nan); });
  expect_refused(Code::invalid_value, "radius", [=] { make_cone(infinite, 1); });
  expect_refused(Code::out_of_range, "height must be positive, is 0", [] { make_cone(1, 0); });
  expect_refused(Code::out_of_range, "radius", [] { make_ball(1e200); });
  expect_refused(Code::out_of_range, "size.y must be positive, is -1", [] { make_blade({1, -1, 1}, 0.5); });
  expect_refused(Code::out_of_range, "bevel must be positive, is 0", [] { make_blade({1, 1, 1}, 0); });
  expect_refused(Code::out_of_range, "bevel", [] { make_blade({1, 1, 1}, 1.5); });
  expect_refused(Code::invalid_value, "bevel", [=] { make_blade({1, 1, 1}, nan); });
}

}  // namespace
}  // namespace crumble
