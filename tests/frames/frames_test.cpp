// The check over consecutive pictures, its instruments first; scripts/verify-frames runs it over all of the paper's
// bodies.
#include "frames/frames.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "crumble/base/random.hpp"
#include "crumble/fracture/masks.hpp"
#include "crumble/tetmesh/lattice_box.hpp"

namespace crumble {
namespace {

using frames::FlickerCounter;
using frames::PopMeter;

TriangleMesh make_cuboid(const Vec3& low, const Vec3& high) {
  TriangleMesh mesh;
  for (unsigned corner = 0; corner < 8; ++corner) {
    mesh.vertices.emplace_back((corner & 1u) != 0 ? high.x() : low.x(), (corner & 2u) != 0 ? high.y() : low.y(),
                               (corner & 4u) != 0 ? high.z() : low.z());
  }
  mesh.triangles = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                    {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
  return mesh;
}

Silhouette picture_of(const TriangleMesh& mesh, const Vec3& towards = {0, 0, 1}) {
  Silhouette picture(make_camera(towards, Vec3::Zero(), 1, 400));
  picture.draw(mesh.vertices, mesh.triangles);
  return picture;
}
constexpr double kPixelArea = (2.0 / 400) * (2.0 / 400);

TEST(Silhouettes, CoverTheProjectedArea) {
  const TriangleMesh cuboid = make_cuboid({-0.2, -0.3, -0.4}, {0.3, 0.4, 0.5});
  ASSERT_EQ(find_surface_defects(cuboid).total(), 0u);
  for (const Vec3& towards : {Vec3(0, 0, 1), Vec3(1, 0, 0), Vec3(1, 2, 3), Vec3(-1, 0.4, 0.2), Vec3(0.1, -1, 0.3)}) {
    const Silhouette picture = picture_of(cuboid, towards);
    const Vec3 d = normalized(towards).cwiseAbs();
    const double area = d.x() * 0.7 * 0.9 + d.y() * 0.5 * 0.9 + d.z() * 0.5 * 0.7;  // of a cuboid 0.5 x 0.7 x 0.9
    EXPECT_NEAR(static_cast<double>(picture.covered_count()) * kPixelArea, area, 0.01 * area);
    EXPECT_EQ(picture.hole_count(), 0u);
    EXPECT_EQ(picture.back_count(), 0u);
  }
}

TEST(Silhouettes, FindAMissingTriangle) {
  TriangleMesh cuboid = make_cuboid({-0.2, -0.3, -0.4}, {0.3, 0.4, 0.5});
  std::swap(cuboid.triangles[2], cuboid.triangles.back());
  cuboid.triangles.pop_back();  // half of the front
  const Silhouette picture = picture_of(cuboid);
  EXPECT_NEAR(static_cast<double>(picture.hole_count()) * kPixelArea, 0.5 * 0.5 * 0.7, 0.002);
  EXPECT_EQ(picture.back_count(), picture.hole_count()) << "there one sees the inside of the rear face";
}

TEST(Silhouettes, SeeBacksOfASurfaceInsideOut) {
  TriangleMesh cuboid = make_cuboid({-0.2, -0.3, -0.4}, {0.3, 0.4, 0.5});
  for (Triangle& triangle : cuboid.triangles) std::swap(triangle[0], triangle[1]);
  const Silhouette picture = picture_of(cuboid, {1, 2, 3});
  EXPECT_EQ(picture.back_count(), picture.covered_count());
  EXPECT_EQ(picture.hole_count(), 0u);
}

// Rays enter and leave a closed surface equally often in every pixel, however crumpled it is.
TEST(Silhouettes, AClosedSurfaceHasNoHoles) {
  Random random(41);
  const TetMesh mesh = make_lattice_box({1, 1, 1}, 0.125);
  for (int crumpling = 0; crumpling < 5; ++crumpling) {
    TriangleMesh surface{mesh.positions, mesh.boundary};
    for (Vec3& p : surface.vertices) {
      for (int axis = 0; axis < 3; ++axis) p[axis] += 0.05 * crumpling * (random.uniform() - 0.5);
    }
    EXPECT_EQ(picture_of(surface, {0.3, 0.2, 1}).hole_count(), 0u);
    EXPECT_EQ(picture_of(surface).hole_count(), 0u) << "sides seen edge-on";
  }
}

TEST(Flicker, CountsWhatIsThereForOnePicture) {
  const TriangleMesh body = make_cuboid({-0.5, -0.5, -0.5}, {0, 0.5, 0.5});
  const TriangleMesh blink = make_cuboid({0.1, -0.1, -0.1}, {0.3, 0.1, 0.1});  // 40 x 40 pixels
  TriangleMesh both = body;
  for (const Triangle& t : blink.triangles) both.triangles.push_back({t[0] + 8, t[1] + 8, t[2] + 8});
  both.vertices.insert(both.vertices.end(), blink.vertices.begin(), blink.vertices.end());
  FlickerCounter appears, vanishes, stays;
  std::size_t appeared = 0, vanished = 0, stayed = 0;
  for (const bool on : {false, true, false, false}) {
    appeared += appears.add(picture_of(on ? both : body));
    vanished += vanishes.add(picture_of(on ? body : both));
    stayed += stays.add(picture_of(both));
  }
  EXPECT_EQ(appeared, 1600u);
  EXPECT_EQ(vanished, 38u * 38u) << "all but the rim, where the outline may have passed";
  EXPECT_EQ(stayed, 0u);
}

TEST(Flicker, LeavesMotionAlone) {
  FlickerCounter flicker;
  std::size_t count = 0;
  for (const int place : {0, 1, 2, 1, 2, 3, 2}) {  // pixels, to and fro
    const double x = place * 2.0 / 400;
    count += flicker.add(picture_of(make_cuboid({x - 0.3, -0.4, -0.1}, {x + 0.2, 0.3, 0.1}), {0, 0, 1}));
  }
  EXPECT_EQ(count, 0u);
}

// A tetrahedron swollen by 30 % stands still while one spring is cut: the cut ends belong at half the rest length, so
// they are 0.3 / 2 of it from where they were.
TEST(Pops, MeasureTheOpeningOfACrack) {
  const TetMesh mesh = make_tet_mesh({{0, 0, 0}, {1, 0, 0}, {0.2, 1, 0.1}, {0.3, 0.4, 0.9}}, {{0, 1, 2, 3}});
  VecArray nodes(mesh.positions);
  for (std::size_t i = 0; i < 4; ++i) nodes.set(i, 1.3 * mesh.positions[i]);
  const std::array<std::uint32_t, 4> fragments{};
  std::array<std::uint8_t, 6> intact{1, 1, 1, 1, 1, 1};
  for (const double settle : {0.0, 0.05}) {
    SurfaceExtractor surface(mesh, {.settle = settle});
    PopMeter pops(mesh);
    intact[0] = 1;
    surface.update({nodes, intact, fragments, 0});
    EXPECT_EQ(pops.add(surface, nodes).motion, 0);
    intact[0] = 0;
    surface.update({nodes, intact, fragments, 0.01});
    const PopMeter::Pops at_once = pops.add(surface, nodes);
    EXPECT_NEAR(at_once.opening, settle == 0 ? 0.15 : 0, 1e-6) << "settle " << settle;
    EXPECT_NEAR(at_once.motion, 0, 1e-12);
    surface.update({nodes, intact, fragments, 1});
    const PopMeter::Pops later = pops.add(surface, nodes);
    EXPECT_NEAR(later.motion, settle == 0 ? 0 : 0.15, 1e-6) << "settle " << settle;
    EXPECT_EQ(later.opening, 0);
  }
}

TEST(Frames, OfTheSlabsPressAreSound) {
  const Scene scene = load_scene("tofu_slab", Preset::standard);
  const frames::Report report = frames::watch(scene, {});
  EXPECT_EQ(frames::complaint(report), "");
  EXPECT_GT(report.frames, 500u);
  EXPECT_GT(report.cuts, 50u) << "something must have broken";

  const frames::Report at_once = frames::watch(scene, {.surface = {.settle = 0}});
  EXPECT_NE(frames::complaint(at_once).find("opening above"), std::string::npos) << at_once.opening.value;
}

}  // namespace
}  // namespace crumble
