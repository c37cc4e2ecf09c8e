#include "render/renderer.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "crumble/base/error.hpp"
#include "crumble/base/memory.hpp"
#include "render/gl_objects.hpp"
#include "render/shaders.hpp"

namespace crumble::render {
namespace {

constexpr int kSamples = 2;  // per axis and pixel
constexpr int kShadowSize = 2048;
constexpr float kFloorMaterial = 4;       // kFloor of the shader, after the last of enum Material
constexpr double kFloorRadius = 9;        // in radii of the scene's bounding sphere
constexpr double kCavityRadius = 0.0035;  // metres: how wide a crack still reads as dark

struct Vertex {
  std::array<float, 3> position, normal, rest_position;
  float material;
};

std::array<float, 3> to_floats(const Vec3& v) {
  return {static_cast<float>(v.x()), static_cast<float>(v.y()), static_cast<float>(v.z())};
}

// Three vertices per triangle, because normals and material belong to the triangle.
Vector<Vertex> expand(const Vector<RenderMesh>& meshes) {
  Vector<Vertex> vertices;
  for (const RenderMesh& mesh : meshes) {
    const Vector<Vec3>& rest = mesh.rest_positions.empty() ? mesh.positions : mesh.rest_positions;
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
      for (int k = 0; k < 3; ++k) {
        const std::uint32_t v = mesh.triangles[t][k];
        const Eigen::Vector3f& normal = mesh.corner_normals[t][k];
        vertices.push_back({to_floats(mesh.positions[v]),
                            {normal.x(), normal.y(), normal.z()},
                            to_floats(rest[v]),
                            static_cast<float>(mesh.materials[t])});
      }
    }
  }
  return vertices;
}

void add_floor(Vector<Vertex>& vertices, const Vec3& center, double radius) {
  constexpr int kCorners[6][2] = {{-1, -1}, {-1, 1}, {1, 1}, {-1, -1}, {1, 1}, {1, -1}};
  for (const auto& [x, z] : kCorners) {
    const auto position = to_floats(center + radius * Vec3(x, 0, z));
    vertices.push_back({position, {0, 1, 0}, position, kFloorMaterial});
  }
}

// What the passes have in common.
struct View {
  BoundingSphere bounds;
  Vec3 to_light, floor_center;
  double floor_radius = 0, near = 0, far = 0, half_height = 0;
  Mat4 view, projection, to_light_clip;
};

View make_view(const Scene& scene, double aspect) {
  View v;
  v.bounds = bounding_sphere(scene.meshes);
  v.to_light = normalized(scene.to_light);
  v.floor_radius = kFloorRadius * v.bounds.radius;
  v.floor_center = v.bounds.center;
  v.floor_center.y() = scene.floor_height.value_or(0);
  const double distance = norm(scene.camera.eye - v.bounds.center);
  const double reach =
      scene.floor_height ? norm(v.floor_center - v.bounds.center) + 1.5 * v.floor_radius : v.bounds.radius;
  v.far = distance + reach;
  // The floor comes closer to the eye than the meshes do; float32 depth bears the small number.
  v.near = v.far / 500;
  if (!scene.floor_height) v.near = std::max(v.near, distance - 1.01 * v.bounds.radius);
  v.view = view_matrix(scene.camera);
  v.projection = perspective_matrix(scene.camera.vertical_fov, aspect, v.near, v.far);
  v.half_height = 1 / static_cast<double>(v.projection(1, 1));
  v.to_light_clip = light_matrix(v.to_light, v.bounds.center, 1.02 * v.bounds.radius);
  return v;
}

}  // namespace

struct Renderer::Impl {
  Program shadow{kShadowVertex, kShadowFragment};
  Program surface{kSurfaceVertex, kSurfaceFragment};
  Program composite{kCompositeVertex, kCompositeFragment};
  Texture shadow_depth = make_texture(GL_DEPTH_COMPONENT32F, GL_DEPTH_COMPONENT, kShadowSize, kShadowSize);
  Framebuffer shadow_target = make_framebuffer({}, shadow_depth.get());
  Sampler shadow_test;  // compares, where the texture's own state reads
  Buffer vertex_buffer = make_buffer();
  VertexArray layout = make_vertex_array(), no_layout = make_vertex_array();
  int width = 0, height = 0;  // of the textures below
  Texture key_light, ambient_light, eye_normal, depth;
  Framebuffer surface_target;

  Impl();
  void resize(int new_width, int new_height);
  void draw_shadow(const View& view, std::size_t vertex_count);
  void draw_surfaces(const Scene& scene, const View& view, std::size_t vertex_count);
  void draw_composite(const View& view, int out_width, int out_height, GLuint framebuffer);
};

Renderer::Impl::Impl() {
  GLuint name = 0;
  glGenSamplers(1, &name);
  shadow_test = Sampler(name);
  glSamplerParameteri(name, GL_TEXTURE_COMPARE_MODE, GL_COMPARE_REF_TO_TEXTURE);
  glSamplerParameteri(name, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
  glSamplerParameteri(name, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
  glSamplerParameteri(name, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
  glSamplerParameteri(name, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
  glBindVertexArray(layout.get());
  glBindBuffer(GL_ARRAY_BUFFER, vertex_buffer.get());
  const auto attribute = [](GLuint index, GLint size, std::size_t offset) {
    glEnableVertexAttribArray(index);
    glVertexAttribPointer(index, size, GL_FLOAT, GL_FALSE, sizeof(Vertex), reinterpret_cast<const void*>(offset));
  };
  attribute(0, 3, offsetof(Vertex, position));
  attribute(1, 3, offsetof(Vertex, normal));
  attribute(2, 3, offsetof(Vertex, rest_position));
  attribute(3, 1, offsetof(Vertex, material));
}

void Renderer::Impl::resize(int new_width, int new_height) {
  if (new_width == width && new_height == height) return;
  width = new_width, height = new_height;
  key_light = make_texture(GL_RGBA16F, GL_RGBA, width, height);
  ambient_light = make_texture(GL_RGBA16F, GL_RGBA, width, height);
  eye_normal = make_texture(GL_RGBA16F, GL_RGBA, width, height);
  depth = make_texture(GL_DEPTH_COMPONENT32F, GL_DEPTH_COMPONENT, width, height);
  surface_target = make_framebuffer({key_light.get(), ambient_light.get(), eye_normal.get()}, depth.get());
}

void Renderer::Impl::draw_shadow(const View& view, std::size_t vertex_count) {
  glBindFramebuffer(GL_FRAMEBUFFER, shadow_target.get());
  glViewport(0, 0, kShadowSize, kShadowSize);
  glClear(GL_DEPTH_BUFFER_BIT);
  shadow.use();
  shadow.set("to_light_clip", view.to_light_clip);
  glDrawArrays(GL_TRIANGLES, 0, static_cast<GLsizei>(vertex_count));
}

void Renderer::Impl::draw_surfaces(const Scene& scene, const View& view, std::size_t vertex_count) {
  glBindFramebuffer(GL_FRAMEBUFFER, surface_target.get());
  glViewport(0, 0, width, height);
  glClearColor(0, 0, 0, 0);
  glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
  glActiveTexture(GL_TEXTURE0);
  glBindTexture(GL_TEXTURE_2D, shadow_depth.get());
  glActiveTexture(GL_TEXTURE1);
  glBindTexture(GL_TEXTURE_2D, shadow_depth.get());
  glBindSampler(1, shadow_test.get());
  surface.use();
  surface.set("shadow_depth", 0);
  surface.set("shadow_test", 1);
  surface.set("view", view.view);
  surface.set("projection", view.projection);
  surface.set("to_light_clip", view.to_light_clip);
  surface.set("eye", scene.camera.eye);
  surface.set("to_light", view.to_light);
  surface.set("floor_center", view.floor_center);
  surface.set("light_radius", view.bounds.radius);
  surface.set("floor_fade", view.floor_radius);
  glDrawArrays(GL_TRIANGLES, 0, static_cast<GLsizei>(vertex_count));
  glBindSampler(1, 0);
}

void Renderer::Impl::draw_composite(const View& view, int out_width, int out_height, GLuint framebuffer) {
  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
  glViewport(0, 0, out_width, out_height);
  glDisable(GL_DEPTH_TEST);
  composite.use();
  int unit = 0;
  const auto bind = [&](const char* name, const Texture& texture) {
    glActiveTexture(static_cast<GLenum>(GL_TEXTURE0 + unit));
    glBindTexture(GL_TEXTURE_2D, texture.get());
    composite.set(name, unit++);
  };
  bind("key_light", key_light);
  bind("ambient_light", ambient_light);
  bind("eye_normal", eye_normal);
  bind("depth", depth);
  composite.set("half_width", view.half_height * out_width / out_height);
  composite.set("half_height", view.half_height);
  composite.set("near", view.near);
  composite.set("far", view.far);
  composite.set("cavity_radius", kCavityRadius);
  composite.set("samples", kSamples);
  glBindVertexArray(no_layout.get());
  glDrawArrays(GL_TRIANGLES, 0, 3);
}

Renderer::Renderer() : impl_(std::make_unique<Impl>()) {}
Renderer::~Renderer() = default;

void Renderer::draw(const Scene& scene, int width, int height, unsigned framebuffer) {
  check(scene);
  require_in_range("width", width, 1, 8192);
  require_in_range("height", height, 1, 8192);
  const View view = make_view(scene, static_cast<double>(width) / height);
  Vector<Vertex> vertices = expand(scene.meshes);
  const std::size_t casters = vertices.size();
  if (scene.floor_height) add_floor(vertices, view.floor_center, view.floor_radius);

  impl_->resize(kSamples * width, kSamples * height);
  glBindVertexArray(impl_->layout.get());
  glBindBuffer(GL_ARRAY_BUFFER, impl_->vertex_buffer.get());
  glBufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(vertices.size() * sizeof(Vertex)), vertices.data(),
               GL_STREAM_DRAW);
  glEnable(GL_DEPTH_TEST);
  glEnable(GL_CULL_FACE);
  impl_->draw_shadow(view, casters);
  impl_->draw_surfaces(scene, view, vertices.size());
  impl_->draw_composite(view, width, height, framebuffer);
}

Image Renderer::draw(const Scene& scene, int width, int height) {
  require_in_range("width", width, 1, 8192);
  require_in_range("height", height, 1, 8192);
  const Texture colour = make_texture(GL_RGB8, GL_RGB, width, height);
  const Framebuffer target = make_framebuffer({colour.get()}, 0);
  draw(scene, width, height, target.get());
  Image image = make_image(width, height, {0, 0, 0});
  glPixelStorei(GL_PACK_ALIGNMENT, 1);
  glReadPixels(0, 0, width, height, GL_RGB, GL_UNSIGNED_BYTE, image.pixels.data());
  for (int y = 0; y < height / 2; ++y) {  // OpenGL counts rows from the bottom
    std::swap_ranges(&image.at(0, y), &image.at(0, y) + width, &image.at(0, height - 1 - y));
  }
  return image;
}

}  // namespace crumble::render
