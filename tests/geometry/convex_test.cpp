#include "crumble/geometry/convex.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "crumble/base/error.hpp"

namespace crumble {
namespace {

TEST(Convex, RoundStickIsAPrismWithAFaceLookingDown) {
  const ConvexPolyhedron stick = make_round_stick(0.004, 0.05, 16);
  EXPECT_EQ(stick.planes.size(), 18u);
  EXPECT_EQ(stick.vertices.size(), 32u);
  EXPECT_NEAR(volume(stick.surface), 0.05 * 8 * 0.004 * 0.004 * std::sin(M_PI / 8), 1e-18);
  const bool looks_down = std::any_of(stick.planes.begin(), stick.planes.end(),
                                      [](const Plane& p) { return norm(p.normal - Vec3(0, -1, 0)) < 1e-12; });
  EXPECT_TRUE(looks_down);
  EXPECT_NEAR(stick.half_thickness, 0.004 * std::cos(M_PI / 16), 1e-15);
}

TEST(Convex, DepthUnderTheFacesOfABar) {
  const ConvexPolyhedron bar = make_bar({0.003, 0.01, 0.05});
  EXPECT_EQ(bar.planes.size(), 6u);
  std::uint32_t nearest = 0;
  EXPECT_NEAR(greatest_plane_distance(bar, {0.001, 0, 0}, nearest), -0.0005, 1e-16);
  EXPECT_LT(norm(bar.planes[nearest].normal - Vec3::UnitX()), 1e-15);
  EXPECT_NEAR(greatest_plane_distance(bar, {0, -0.007, 0}, nearest), 0.002, 1e-16);
}

TEST(Convex, RefusesBadMeshesByName) {
  const auto code_of = [](const std::function<void(TriangleMesh&)>& damage) {
    TriangleMesh mesh = make_bar({1, 1, 1}).surface;
    damage(mesh);
    try {
      make_convex(mesh);
    } catch (const Error& error) {
      return error.code();
    }
    return Code{0};
  };
  EXPECT_EQ(code_of([](auto&) {}), Code{0});
  EXPECT_EQ(code_of([](auto& m) { m.triangles.clear(); }), Code::mesh);
  EXPECT_EQ(code_of([](auto& m) { m.triangles.pop_back(); }), Code::mesh_open);
  EXPECT_EQ(code_of([](auto& m) { m.triangles[3][1] = 99; }), Code::mesh);
  EXPECT_EQ(code_of([](auto& m) { m.vertices[2].y() = std::nan(""); }), Code::mesh);
  EXPECT_EQ(code_of([](auto& m) { m.vertices[1] = m.vertices[0]; }), Code::mesh);
  EXPECT_EQ(code_of([](auto& m) { std::swap(m.triangles[0][0], m.triangles[0][1]); }), Code::mesh_orientation);
  EXPECT_EQ(code_of([](auto& m) {
              for (auto& t : m.triangles) std::swap(t[0], t[1]);
            }),
            Code::mesh_orientation);
  EXPECT_EQ(code_of([](auto& m) { m.vertices[7] = {0.1, 0.1, 0.1}; }), Code::mesh_nonconvex);
}

}  // namespace
}  // namespace crumble
