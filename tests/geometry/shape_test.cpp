#include "crumble/geometry/shape.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "crumble/base/error.hpp"
#include "crumble/base/memory.hpp"
#include "crumble/base/random.hpp"

namespace crumble {
namespace {

Vector<std::unique_ptr<Shape>> shapes() {
  Vector<std::unique_ptr<Shape>> list;
  list.push_back(make_box({0.03, 0.01, 0.02}));
  list.push_back(make_sphere(0.02));
  list.push_back(make_cylinder(0.015, 0.03));
  return list;
}

TEST(Shape, ProjectionLiesOnTheSurfaceAtTheSignedDistance) {
  for (const auto& shape : shapes()) {
    Random random(1);
    for (int i = 0; i < 20000; ++i) {
      const Vec3 p(random.uniform(-0.03, 0.03), random.uniform(-0.02, 0.05), random.uniform(-0.03, 0.03));
      const SurfacePoint on = shape->project(p);
      ASSERT_NEAR(shape->signed_distance(on.point), 0, 1e-15);
      ASSERT_NEAR(norm(on.point - p), std::abs(shape->signed_distance(p)), 1e-15);
      ASSERT_NEAR(norm(on.normal), 1, 1e-14);
      // outward: a little along the normal is outside
      ASSERT_GT(shape->signed_distance(on.point + 1e-6 * on.normal), 0);
    }
  }
}

TEST(Shape, VolumeByMonteCarlo) {
  for (const auto& shape : shapes()) {
    Random random(2);
    const Vec3 low = shape->lower(), size = shape->upper() - low;
    int inside = 0;
    constexpr int kSamples = 200000;
    for (int i = 0; i < kSamples; ++i) {
      const Vec3 p = low + size.cwiseProduct(Vec3(random.uniform(), random.uniform(), random.uniform()));
      inside += shape->signed_distance(p) < 0;
    }
    EXPECT_NEAR(inside / double{kSamples} * size.x() * size.y() * size.z() / shape->volume(), 1, 0.01);
  }
}

TEST(Shape, CreasesJoinTheirCornersOnTheSurface) {
  EXPECT_EQ(shapes()[0]->creases().size(), 12u);
  for (const auto& shape : shapes()) {
    for (const Crease& crease : shape->creases()) {
      for (int i = 0; i <= 10; ++i) EXPECT_NEAR(shape->signed_distance(crease.at(crease.length * i / 10)), 0, 1e-15);
      if (crease.closed) continue;
      EXPECT_LT(norm(crease.at(0) - shape->corners()[crease.first_corner]), 1e-15);
      EXPECT_LT(norm(crease.at(crease.length) - shape->corners()[crease.last_corner]), 1e-15);
    }
  }
}

TEST(Shape, BoxFacesAreExact) {
  const auto box = make_box({0.03, 0.03, 0.03});
  EXPECT_EQ(box->project({0.001, 0.002, 0.003}).point.y(), 0.0);
  EXPECT_EQ(box->lower().y(), 0.0);
}

TEST(Shape, RefusesSizesThatAreNotPositive) {
  EXPECT_THROW(make_box({0.03, 0, 0.03}), Error);
  EXPECT_THROW(make_sphere(-1), Error);
  try {
    make_cylinder(0.01, std::nan(""));
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), Code::invalid_value);
    EXPECT_NE(std::string(error.what()).find("height must be finite, is nan"), std::string::npos);
  }
}

}  // namespace
}  // namespace crumble
