// Pictures against what geometry says they must show. One context for all tests: making one takes a quarter second.
#include "render/renderer.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <numbers>

#include "crumble/base/error.hpp"
#include "crumble/base/memory.hpp"
#include "crumble/geometry/convex.hpp"
#include "render/broken_box.hpp"
#include "render/offscreen_context.hpp"

namespace crumble::render {
namespace {

constexpr int kWidth = 240, kHeight = 180;

class RendererTest : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    context_ = std::make_unique<OffscreenContext>();
    renderer_ = std::make_unique<Renderer>();
  }
  static void TearDownTestSuite() {
    renderer_.reset();
    context_.reset();
  }
  static Image draw(const Scene& scene) { return renderer_->draw(scene, kWidth, kHeight); }

 private:
  static inline std::unique_ptr<OffscreenContext> context_;
  static inline std::unique_ptr<Renderer> renderer_;
};

RenderMesh whole(const TriangleMesh& mesh, Material material, double crease_degrees) {
  return make_render_mesh(mesh, Vector<Material>(mesh.triangles.size(), material), crease_degrees);
}

RenderMesh box(const Vec3& size, const Vec3& center) {
  RenderMesh mesh = whole(make_bar(size).surface, Material::skin, 30);
  for (Vec3& p : mesh.positions) p += center;
  return mesh;
}

RenderMesh sphere(double radius) {
  constexpr int kRows = 48, kColumns = 96;
  TriangleMesh mesh;
  for (int i = 0; i <= kRows; ++i) {
    for (int j = 0; j < kColumns; ++j) {
      const double theta = std::numbers::pi * i / kRows, phi = 2 * std::numbers::pi * j / kColumns;
      mesh.vertices.push_back(radius *
                              Vec3(std::sin(theta) * std::sin(phi), std::cos(theta), std::sin(theta) * std::cos(phi)));
    }
  }
  for (std::uint32_t i = 0; i < kRows; ++i) {
    for (std::uint32_t j = 0; j < kColumns; ++j) {
      const std::uint32_t a = i * kColumns + j, b = i * kColumns + (j + 1) % kColumns;
      mesh.triangles.push_back({a, a + kColumns, b + kColumns});
      mesh.triangles.push_back({a, b + kColumns, b});
    }
  }
  return whole(mesh, Material::skin, 180);
}

int brightness(const Rgb& pixel) {
  return pixel[0] + pixel[1] + pixel[2];
}

bool differs(const Rgb& a, const Rgb& b) {
  return std::abs(brightness(a) - brightness(b)) > 12;
}

/// Without a floor the background depends on the row alone, and the first column shows it.
int silhouette_area(const Image& image) {
  int area = 0;
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) area += differs(image.at(x, y), image.at(0, y));
  }
  return area;
}

/// Pixels per unit of tangent at the picture's centre.
double focal_length(const Camera& camera) {
  return 0.5 * kHeight / std::tan(camera.vertical_fov / 2);
}

struct Pixel {
  int x, y;
};

Pixel pixel_of(const Camera& camera, const Vec3& p) {
  const Vec3 forward = normalized(camera.target - camera.eye), right = normalized(cross(forward, camera.up));
  const Vec3 up = cross(right, forward), d = p - camera.eye;
  const double scale = focal_length(camera) / dot(d, forward);
  return {static_cast<int>(std::lround(0.5 * kWidth + scale * dot(d, right) - 0.5)),
          static_cast<int>(std::lround(0.5 * kHeight - scale * dot(d, up) - 0.5))};
}

TEST_F(RendererTest, SphereCoversItsConeOfSight) {
  Scene scene;
  scene.meshes = {sphere(0.015)};
  scene.floor_height.reset();
  scene.camera.eye = {0, 0, 0.1};
  const double sine = 0.015 / 0.1, radius = focal_length(scene.camera) * sine / std::sqrt(1 - sine * sine);
  EXPECT_NEAR(silhouette_area(draw(scene)), std::numbers::pi * radius * radius,
              0.02 * std::numbers::pi * radius * radius);
}

TEST_F(RendererTest, BoxSeenFaceOnCoversItsFrontFace) {
  Scene scene;
  scene.meshes = {box({0.03, 0.02, 0.03}, {0, 0, 0})};
  scene.floor_height.reset();
  scene.camera.eye = {0, 0, 0.115};
  const double scale = focal_length(scene.camera) / 0.1;
  const double area = 0.03 * 0.02 * scale * scale;
  EXPECT_NEAR(silhouette_area(draw(scene)), area, 0.03 * area);
}

TEST_F(RendererTest, SphereIsLitFromTheSideOfTheLight) {
  Scene scene;
  scene.meshes = {sphere(0.015)};
  scene.floor_height.reset();
  scene.camera.eye = {0, 0, 0.1};
  for (const double side : {-1.0, 1.0}) {
    scene.to_light = {side, 0, 0.3};
    const Image image = draw(scene);
    const int shift = static_cast<int>(0.1 * kWidth * side);
    EXPECT_GT(brightness(image.at(kWidth / 2 + shift, kHeight / 2)),
              1.25 * brightness(image.at(kWidth / 2 - shift, kHeight / 2)));
  }
}

TEST_F(RendererTest, BoxThrowsItsShadowWhereTheLightsRayMeetsTheFloor) {
  const Vec3 center(0, 0.015, 0);
  Scene scene;
  scene.meshes = {box({0.03, 0.03, 0.03}, center)};
  scene.camera = fit_camera({-0.06, 0, -0.03}, {0.06, 0.03, 0.03}, {0, -1, -1}, 0.5, 4.0 / 3, 0.05);
  scene.to_light = {-1, 0.8, 0.1};
  const Image image = draw(scene);
  const Vec3 upper_edge(0.015, 0.03, 0), ray = -scene.to_light;
  const Vec3 shadow = upper_edge + upper_edge.y() / -ray.y() * ray;
  const Vec3 within = 0.5 * (shadow + Vec3(0.015, 0, 0)), mirrored(-within.x(), 0, -within.z());
  const Pixel dark = pixel_of(scene.camera, within), bright = pixel_of(scene.camera, mirrored);
  EXPECT_LT(brightness(image.at(dark.x, dark.y)), 0.7 * brightness(image.at(bright.x, bright.y)));
  const Pixel beyond = pixel_of(scene.camera, shadow + Vec3(0.006, 0, 0));
  EXPECT_NEAR(brightness(image.at(beyond.x, beyond.y)), brightness(image.at(bright.x, bright.y)), 60);
}

TEST_F(RendererTest, BrokenFacesAreDarkerAndWarmerThanTheSkin) {
  const auto mean_colour = [&](Material material) {
    RenderMesh mesh = box({0.03, 0.03, 0.03}, {0, 0, 0});
    mesh.materials.assign(mesh.triangles.size(), material);
    Scene scene;
    scene.meshes = {mesh};
    scene.floor_height.reset();
    scene.camera.eye = {0, 0, 0.1};
    const Image image = draw(scene);
    Vec3 sum = Vec3::Zero();
    for (int y = kHeight / 2 - 20; y < kHeight / 2 + 20; ++y) {
      for (int x = kWidth / 2 - 20; x < kWidth / 2 + 20; ++x) {
        for (int k = 0; k < 3; ++k) sum[k] += image.at(x, y)[k] / 1600.0;
      }
    }
    return sum;
  };
  const Vec3 skin = mean_colour(Material::skin), interior = mean_colour(Material::interior);
  EXPECT_GT(skin[1], interior[1] + 10);
  EXPECT_GT(interior[0] / interior[2], 1.15 * skin[0] / skin[2]);
}

TEST_F(RendererTest, OpenCrackShowsItsBrokenFaces) {
  Scene scene;
  scene.meshes = {make_piece(0, 0.3), make_piece(1, 0.3), make_stick(0.01)};
  scene.camera = fit_camera({-0.025, 0, -0.025}, {0.025, 0.036, 0.025}, {-0.4, -0.6, -1}, 0.5, 4.0 / 3, 0.02);
  const Image with = draw(scene);
  for (RenderMesh& mesh : scene.meshes) {
    for (Material& m : mesh.materials) m = m == Material::interior ? Material::skin : m;
  }
  const Image without = draw(scene);
  int changed = 0;
  for (std::size_t i = 0; i < with.pixels.size(); ++i) changed += differs(with.pixels[i], without.pixels[i]);
  EXPECT_GT(changed, kWidth * kHeight / 50);
  EXPECT_LT(changed, kWidth * kHeight / 5);
}

TEST_F(RendererTest, DrawsTheSamePictureTwice) {
  Scene scene;
  scene.meshes = {make_piece(0, 0.2)};
  const Image first = draw(scene);
  EXPECT_EQ(first.pixels, draw(scene).pixels);
}

TEST_F(RendererTest, RefusesBadScenes) {
  Scene good;
  good.meshes = {box({0.03, 0.03, 0.03}, {0, 0, 0})};
  const auto code_of = [&](auto&& spoil) {
    Scene scene = good;
    spoil(scene);
    try {
      draw(scene);
    } catch (const Error& error) {
      return error.code();
    }
    return Code::internal;
  };
  EXPECT_EQ(code_of([](Scene& s) { s.meshes.clear(); }), Code::empty);
  EXPECT_EQ(code_of([](Scene& s) { s.meshes[0].corner_normals.pop_back(); }), Code::mesh);
  EXPECT_EQ(code_of([](Scene& s) { s.meshes[0].materials.pop_back(); }), Code::mesh);
  EXPECT_EQ(code_of([](Scene& s) { s.meshes[0].triangles[3][1] = 1000; }), Code::mesh);
  EXPECT_EQ(code_of([](Scene& s) { s.meshes[0].positions[0].x() = std::nan(""); }), Code::invalid_value);
  EXPECT_EQ(code_of([](Scene& s) { s.to_light = Vec3::Zero(); }), Code::out_of_range);
  EXPECT_EQ(code_of([](Scene& s) { s.meshes[0].positions.assign(8, Vec3::Zero()); }), Code::out_of_range);
}

TEST(OffscreenContextTest, AMissingDriverIsAnErrorThatNamesEgl) {
  // In a fresh process, because EGL looks for drivers once.
  GTEST_FLAG_SET(death_test_style, "threadsafe");
  const auto make_without_driver = [] {
    ::setenv("__EGL_VENDOR_LIBRARY_FILENAMES", "/nowhere", 1);
    try {
      const OffscreenContext context;
    } catch (const Error& error) {
      std::fputs(error.what(), stderr);
      std::exit(error.code() == Code::unsupported ? 7 : 1);
    }
    std::exit(0);
  };
  EXPECT_EXIT(make_without_driver(), ::testing::ExitedWithCode(7), "EGL error 0x");
}

TEST(RenderMeshTest, NormalsBreakAtSharpEdgesOnly) {
  const RenderMesh cube = box({1, 1, 1}, {0, 0, 0});
  for (const CornerNormals& corners : cube.corner_normals) {
    for (const Eigen::Vector3f& normal : corners) EXPECT_FLOAT_EQ(normal.cwiseAbs().maxCoeff(), 1);
  }
  const RenderMesh round = sphere(2);
  for (std::size_t t = 0; t < round.triangles.size(); ++t) {
    for (int k = 0; k < 3; ++k) {
      const Vec3 outward = round.positions[round.triangles[t][k]] / 2;
      EXPECT_GT(dot(round.corner_normals[t][k].cast<double>(), outward), 0.997);
    }
  }
}

}  // namespace
}  // namespace crumble::render
