// Convex sets given by a support function against closed forms.
#include "crumble/geometry/support_solid.hpp"

#include <gtest/gtest.h>

#include <functional>

#include "crumble/base/error.hpp"
#include "crumble/base/memory.hpp"
#include "crumble/base/random.hpp"
#include "support/allocation_counter.hpp"

namespace crumble {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

// One of the sets below; all are about the origin.
struct Set {
  enum Kind { ball, box, ellipsoid, capsule, polyhedron } kind;
  Vec3 size;  // radius; half edges; half axes; radius and half length along z
  ConvexPolyhedron body = {};
};

void support_of(void* context, const double direction[3], double point[3]) {
  const Set& set = *static_cast<const Set*>(context);
  const Vec3 d(direction[0], direction[1], direction[2]);
  Vec3 p = Vec3::Zero();
  switch (set.kind) {
    case Set::ball:
      p = set.size.x() * d;
      break;
    case Set::box:
      for (int k = 0; k < 3; ++k) p[k] = d[k] < 0 ? -set.size[k] : set.size[k];
      break;
    case Set::ellipsoid: {
      const Vec3 scaled = set.size.cwiseProduct(d);
      p = set.size.cwiseProduct(scaled) / scaled.norm();
      break;
    }
    case Set::capsule:
      p = set.size.x() * d + Vec3(0, 0, d.z() < 0 ? -set.size.y() : set.size.y());
      break;
    case Set::polyhedron:
      p = set.body.vertices[0];
      for (const Vec3& v : set.body.vertices) {
        if (v.dot(d) > p.dot(d)) p = v;
      }
  }
  for (int k = 0; k < 3; ++k) point[k] = p[k];
}

// Foot on an ellipsoid: all solutions of q = a^2 p / (a^2 + s), by bisection for the root right of the last pole, where
// the nearest one is (Eberly, Distance from a Point to an Ellipsoid).
double ellipsoid_distance(const Vec3& half_axes, const Vec3& at) {
  const Vec3 p = at.cwiseAbs().cwiseMax(1e-12 * half_axes);  // no zeros: the pole then bounds the root
  const Vec3 squares = half_axes.cwiseProduct(half_axes);
  const auto value = [&](double s) {
    double sum = -1;
    for (int k = 0; k < 3; ++k) sum += squares[k] * p[k] * p[k] / ((squares[k] + s) * (squares[k] + s));
    return sum;
  };
  double low = -squares.minCoeff(), high = half_axes.maxCoeff() * (p.norm() + half_axes.maxCoeff());
  for (int i = 0; i < 200; ++i) {
    const double middle = 0.5 * (low + high);
    (value(middle) > 0 ? low : high) = middle;
  }
  Vec3 q;
  for (int k = 0; k < 3; ++k) q[k] = squares[k] * p[k] / (squares[k] + high);
  return (value(0) < 0 ? -1 : 1) * (p - q).norm();
}

double exact_distance(const Set& set, const Vec3& p) {
  switch (set.kind) {
    case Set::ball:
      return p.norm() - set.size.x();
    case Set::box: {
      const Vec3 q = p.cwiseAbs() - set.size;
      return q.cwiseMax(0.0).norm() + std::min(q.maxCoeff(), 0.0);
    }
    case Set::ellipsoid:
      return ellipsoid_distance(set.size, p);
    case Set::capsule:
      return (p - Vec3(0, 0, std::clamp(p.z(), -set.size.y(), set.size.y()))).norm() - set.size.x();
    default:
      return nearest_surface(set.body, p).signed_distance;
  }
}

struct Case {
  std::string name;
  Set set;
  double tolerance;  // of the size
};

// In metres, of the size of tools.
Vector<Case> cases() {
  Vector<Case> list;
  list.push_back({"ball", {Set::ball, {0.004, 0, 0}}, 1e-9});
  list.push_back({"box", {Set::box, {0.003, 0.005, 0.025}}, 1e-9});
  list.push_back({"ellipsoid", {Set::ellipsoid, {0.004, 0.006, 0.01}}, 1e-9});
  list.push_back({"capsule", {Set::capsule, {0.004, 0.02, 0}}, 1e-9});
  list.push_back({"stick", {Set::polyhedron, {0.004, 0.004, 0.025}, make_round_stick(0.004, 0.05, 16)}, 1e-9});
  list.push_back({"plate", {Set::box, {0.02, 0.0004, 0.01}}, 1e-9});
  list.push_back({"thin ellipsoid", {Set::ellipsoid, {0.01, 0.0002, 0.01}}, 1e-9});
  return list;
}

Solid solid_of(const Set& set) {
  return make_support_solid({support_of, const_cast<Set*>(&set)}, Vec3::Zero());
}

Vec3 extent_of(const Set& set) {
  if (set.kind == Set::ball) return Vec3::Constant(set.size.x());
  if (set.kind == Set::capsule) return {set.size.x(), set.size.x(), set.size.x() + set.size.y()};
  return set.size;
}

Vec3 random_in(const Vec3& extent, Random& random) {
  return extent.cwiseProduct(Vec3(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)));
}

TEST(SupportSolid, DistancesEqualClosedForms) {
  Random random(1);
  for (const Case& c : cases()) {
    SCOPED_TRACE(c.name);
    const Solid solid = solid_of(c.set);
    const Vec3 extent = extent_of(c.set);
    const double size = 2 * extent.norm(), tolerance = c.tolerance * size;
    std::uint32_t hint = 0;
    double worst_inside = 0, worst_outside = 0;
    int inside = 0;
    for (int i = 0; i < 14500; ++i) {
      const Vec3 p = random_in(1.3 * extent, random);
      const double expected = exact_distance(c.set, p);
      SolidPoint found;
      if (std::abs(expected) > tolerance) {
        ASSERT_EQ(solid->find_inside(p, hint, found), expected < 0) << p.transpose() << " at " << expected;
      }
      if (expected > 0 && i % 4) continue;
      const SolidPoint near = solid->nearest(p, kInfinity);
      double& worst = expected < 0 ? worst_inside : worst_outside;
      worst = std::max(worst, std::abs(near.signed_distance - expected) / size);
      EXPECT_NEAR(near.signed_distance, expected, tolerance) << p.transpose();
      EXPECT_NEAR(near.normal.norm(), 1, 1e-14);
      EXPECT_NEAR((p - near.point).dot(near.normal), near.signed_distance, 1e-14 * size);
      // an angle off by e puts the distance off by e^2 and the point by e
      EXPECT_LT(std::abs(exact_distance(c.set, near.point)), 30 * tolerance + 3e-5 * std::abs(expected))
          << p.transpose() << " at " << expected;
      if (testing::Test::HasFailure()) return;
      inside += expected < 0;
    }
    EXPECT_GT(inside, 2000);
    RecordProperty(c.name, std::to_string(worst_inside) + " " + std::to_string(worst_outside));
    std::printf("%-15s greatest error over size: %.1e inside, %.1e outside\n", c.name.c_str(), worst_inside,
                worst_outside);
  }
}

TEST(SupportSolid, FarPointsAreAnsweredWithMoreThanFar) {
  Random random(2);
  for (const Case& c : cases()) {
    const Solid solid = solid_of(c.set);
    for (int i = 0; i < 1000; ++i) {
      const Vec3 p = random_in(3 * extent_of(c.set), random);
      const double exact = exact_distance(c.set, p);
      if (exact > 1.01e-3) {
        ASSERT_GT(solid->nearest(p, 1e-3).signed_distance, 1e-3) << c.name;
      }
    }
  }
}

TEST(SupportSolid, LeavesAlongTheWayOut) {
  Random random(3);
  for (const Case& c : cases()) {
    const Solid solid = solid_of(c.set);
    for (int i = 0; i < 1000; ++i) {
      const Vec3 p = random_in(extent_of(c.set), random), direction = random_in(Vec3::Ones(), random).normalized();
      if (exact_distance(c.set, p) > -1e-6) continue;
      SolidPoint out;
      ASSERT_TRUE(solid->leave_along(p, direction, out)) << c.name;
      ASSERT_NEAR(exact_distance(c.set, out.point), 0, 1e-7 * extent_of(c.set).norm()) << c.name;
      ASSERT_LT((out.point - p + out.signed_distance * direction).norm(), 1e-15);
      ASSERT_GT(out.normal.dot(direction), -1e-6);
    }
  }
}

TEST(SupportSolid, QueriesAllocateNothing) {
  if (!AllocationCounter::available()) GTEST_SKIP() << "nothing counts here";
  const auto list = cases();
  const Solid solid = solid_of(list[2].set);
  Random random(4);
  const AllocationCounter counter;
  std::uint32_t hint = 0;
  for (int i = 0; i < 1000; ++i) {
    const Vec3 p = random_in(extent_of(list[2].set), random);
    SolidPoint out;
    solid->find_inside(p, hint, out);
    solid->nearest(p, 1);
    solid->leave_along(p, Vec3::UnitX(), out);
  }
  EXPECT_EQ(counter.count(), 0u);
}

TEST(SupportSolid, TellsItsThicknessCornersAndSurface) {
  for (const Case& c : cases()) {
    const Solid solid = solid_of(c.set);
    const Vec3 extent = extent_of(c.set);
    const double thinnest = c.set.kind == Set::polyhedron ? c.set.body.half_thickness : extent.minCoeff();
    EXPECT_NEAR(solid->half_thickness(), thinnest, 1e-5 * extent.norm()) << c.name;
    EXPECT_EQ(solid->corners().size(), 8u);
    EXPECT_LT((solid->corners()[7] - extent).norm(), 0.01 * extent.norm()) << c.name;
    for (const Vec3& v : solid->surface().vertices) {
      ASSERT_NEAR(exact_distance(c.set, v), 0, 1e-12) << c.name;
    }
    EXPECT_GT(volume(solid->surface()), 0) << c.name;
    EXPECT_EQ(find_surface_defects(solid->surface()).flipped_edges, 0u) << c.name;
  }
}

TEST(SupportSolid, PointsThatAreNoNumbersAreOutside) {
  const auto list = cases();
  const Solid solid = solid_of(list[0].set);
  std::uint32_t hint = 99999;
  SolidPoint out;
  for (const double bad : {std::nan(""), kInfinity, -kInfinity, 1e300}) {
    EXPECT_FALSE(solid->find_inside({bad, 0, 0}, hint, out));
    solid->nearest({bad, 0, 0}, kInfinity);
    EXPECT_FALSE(solid->leave_along({bad, 0, 0}, Vec3::UnitX(), out));
  }
}

TEST(SupportSolid, BytesTellItFromOthersAndAreRefused) {
  const auto list = cases();
  ByteWriter first, again, other;
  solid_of(list[0].set)->write(first);
  solid_of(list[0].set)->write(again);
  solid_of(list[1].set)->write(other);
  EXPECT_EQ(first.bytes(), again.bytes());
  EXPECT_NE(first.bytes(), other.bytes());
  ByteReader in(first.bytes(), "test");
  try {
    read_solid(in);
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), Code::unsupported);
    EXPECT_NE(std::string(error.what()).find("support function"), std::string::npos) << error.what();
  }
}

// A function made of a lambda.
using Function = std::function<Vec3(const Vec3&)>;
void call(void* context, const double direction[3], double point[3]) {
  const Vec3 p = (*static_cast<Function*>(context))({direction[0], direction[1], direction[2]});
  for (int k = 0; k < 3; ++k) point[k] = p[k];
}

std::pair<Code, std::string> refusal_of(Function function, const Vec3& inside = Vec3::Zero()) {
  try {
    make_support_solid({call, &function}, inside);
  } catch (const Error& error) {
    return {error.code(), error.what()};
  }
  return {Code{0}, ""};
}

TEST(SupportSolid, BadFunctionsAreRefusedByName) {
  const auto ball = [](const Vec3& d) -> Vec3 { return 0.01 * d; };
  EXPECT_EQ(refusal_of(ball).first, Code{0});
  const auto expect = [](const std::pair<Code, std::string>& refusal, Code code, const std::string& words) {
    EXPECT_EQ(refusal.first, code) << refusal.second;
    EXPECT_NE(refusal.second.find(words), std::string::npos) << refusal.second;
  };
  try {
    make_support_solid({}, Vec3::Zero());
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), Code::null);
  }
  expect(refusal_of(ball, {0, std::nan(""), 0}), Code::invalid_value, "tool.inside.y");
  expect(refusal_of(ball, {0, 0.02, 0}), Code::out_of_range, "tool.inside lies");
  expect(refusal_of(ball, {0, 0.01, 0}), Code::out_of_range, "tool.inside lies");
  expect(refusal_of([](const Vec3& d) -> Vec3 { return -0.01 * d; }), Code::invalid_value, "width along +x is -0.02");
  expect(refusal_of([](const Vec3&) -> Vec3 { return Vec3(1, 2, 3); }), Code::out_of_range, "set 0 m wide along +x");
  expect(refusal_of([](const Vec3& d) -> Vec3 { return {d.x(), d.y(), 0}; }), Code::out_of_range, "wide along +z");
  expect(refusal_of([](const Vec3& d) -> Vec3 { return 2000 * d; }), Code::out_of_range, "along -x gives -2000 m");
  expect(refusal_of([](const Vec3&) -> Vec3 { return Vec3::Constant(std::nan("")); }), Code::invalid_value, "along -x");
  expect(refusal_of([](const Vec3& d) -> Vec3 { return (d.x() > 0.3 && d.x() < 0.9 ? 0.5 : 1) * d; }),
         Code::invalid_value, "another of its points lies");
}

}  // namespace
}  // namespace crumble
