#include "bubblemesh/delaunay.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "crumble/base/error.hpp"
#include "crumble/base/memory.hpp"
#include "crumble/base/random.hpp"

namespace crumble {
namespace {

Vec3 as_vector(const GridPoint& p) {
  return Vec3(p.x, p.y, p.z);
}

double volume_of(const Vector<GridPoint>& points, const Vector<Tetrahedron>& tetrahedra) {
  double sum = 0;
  for (const auto& [a, b, c, d] : tetrahedra) {
    const double volume =
        orient(as_vector(points[a]), as_vector(points[b]), as_vector(points[c]), as_vector(points[d]));
    EXPECT_GT(volume, 0);
    sum += volume / 6;
  }
  return sum;
}

void expect_empty_spheres(const Vector<GridPoint>& points, const Vector<Tetrahedron>& tetrahedra) {
  std::size_t violations = 0;
  for (const auto& [a, b, c, d] : tetrahedra) {
    for (const GridPoint& e : points) violations += in_sphere(points[a], points[b], points[c], points[d], e);
  }
  EXPECT_EQ(violations, 0u);
}

TEST(Delaunay, RandomPointsHaveEmptySpheres) {
  Random random(5);
  Vector<Vec3> points;
  for (int i = 0; i < 400; ++i) points.push_back({random.uniform(), random.uniform(), random.uniform()});
  const Vector<GridPoint> grid = quantize(points);
  const Vector<Tetrahedron> tetrahedra = delaunay(grid);
  expect_empty_spheres(grid, tetrahedra);
  const double cube = std::pow(1 << (kCoordinateBits - 1), 3);
  EXPECT_NEAR(volume_of(grid, tetrahedra) / cube, 0.9, 0.1);  // of the points' hull; overlaps would exceed 1
  EXPECT_LT(volume_of(grid, tetrahedra), cube);
}

// A cubic grid is the worst case of cospherical points: eight on each sphere, planes everywhere.
TEST(Delaunay, CubicGridIsFilledExactly) {
  constexpr int kSide = 7, kStep = 250000;
  Vector<GridPoint> grid;
  for (int i = 0; i < kSide * kSide * kSide; ++i) {
    const auto place = [](int k) { return (1 << 20) + kStep * k; };
    grid.push_back({place(i % kSide), place(i / kSide % kSide), place(i / kSide / kSide)});
  }
  const Vector<Tetrahedron> tetrahedra = delaunay(grid);
  expect_empty_spheres(grid, tetrahedra);
  EXPECT_NEAR(volume_of(grid, tetrahedra) / std::pow(double{kStep} * (kSide - 1), 3), 1, 1e-9);
}

TEST(Delaunay, QuantizedPointsFillTheMiddleHalf) {
  const Vector<GridPoint> grid = quantize(Vector<Vec3>{{-2, 0, 0}, {6, 1, 1}, {0, 8, 0}});
  constexpr std::int32_t kQuarter = 1 << (kCoordinateBits - 2);
  EXPECT_EQ(grid[0].x, kQuarter);
  EXPECT_EQ(grid[1].x, 3 * kQuarter);
  EXPECT_EQ(grid[2].y, 3 * kQuarter);
}

TEST(Delaunay, RefusesTheSamePointTwice) {
  const Vector<GridPoint> grid{{1 << 20, 1 << 20, 1 << 20}, {1 << 21, 1 << 20, 5}, {1 << 20, 1 << 20, 1 << 20}};
  try {
    delaunay(grid);
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), Code::duplicate_node);
  }
}

}  // namespace
}  // namespace crumble
