#include "bubblemesh/predicates.hpp"

#include <gtest/gtest.h>

#include <array>

#include "crumble/base/random.hpp"
#include "crumble/base/vec.hpp"

namespace crumble {
namespace {

TEST(Predicates, OrientationAgreesWithDoublesWhereTheyAreExact) {
  Random random(3);
  for (int i = 0; i < 1000; ++i) {
    std::array<GridPoint, 4> g;
    std::array<Vec3, 4> v;
    for (int k = 0; k < 4; ++k) {  // 12 bits: the determinant has fewer than 53
      g[k] = {static_cast<int>(random.below(9)), static_cast<int>(random.below(4096)),
              static_cast<int>(random.below(9))};
      v[k] = Vec3(g[k].x, g[k].y, g[k].z);
    }
    const double volume = orient(v[0], v[1], v[2], v[3]);
    EXPECT_EQ(orient_sign(g[0], g[1], g[2], g[3]), volume > 0 ? 1 : volume < 0 ? -1 : 0);
  }
}

TEST(Predicates, OrientationSeesOneUnitOverTheWholeCube) {
  constexpr std::int32_t kFar = 1 << kCoordinateBits;
  const GridPoint a{0, 0, 0}, b{kFar, kFar, 0}, c{kFar - 1, kFar, kFar};
  // the plane of a, b, c meets z = 1 where kFar (x - y) = -1: never at integers, so x = y is on one side, x = y - 1 on
  // the other
  EXPECT_EQ(orient_sign(a, b, c, {5, 5, 1}) * orient_sign(a, b, c, {4, 5, 1}), -1);
  EXPECT_EQ(orient_sign(a, b, c, {7, 7, 0}), 0);
}

// 24 points (+-a, +-b, +-c) in all orders lie exactly on one sphere; what is inside follows from the squared distance
// alone.
TEST(Predicates, SphereIsStrict) {
  constexpr std::int32_t kCenter = 1 << 21, kA = 1900001, kB = 700003, kC = 300007;
  const auto at = [](std::int32_t x, std::int32_t y, std::int32_t z) {
    return GridPoint{kCenter + x, kCenter + y, kCenter + z};
  };
  const GridPoint a = at(kA, kB, kC), b = at(-kB, kC, kA), c = at(kC, -kA, -kB);
  for (const GridPoint& d : {at(kB, kA, -kC), at(-kA, -kC, -kB), at(-kC, kB, -kA)}) {
    const bool positive = orient_sign(a, b, c, d) > 0;
    ASSERT_NE(orient_sign(a, b, c, d), 0);
    const auto inside = [&](const GridPoint& e) {
      return positive ? in_sphere(a, b, c, d, e) : in_sphere(b, a, c, d, e);
    };
    EXPECT_FALSE(inside(at(-kA, kB, -kC)));
    EXPECT_TRUE(inside(at(-kA, kB, -kC + 1)));
    EXPECT_FALSE(inside(at(-kA, kB, -kC - 1)));
    EXPECT_TRUE(inside(at(0, 0, 0)));
    EXPECT_FALSE(inside(at(kCenter, kCenter, kCenter)));
  }
}

}  // namespace
}  // namespace crumble
