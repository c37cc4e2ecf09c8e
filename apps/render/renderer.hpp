// Draws a scene with OpenGL 3.3 core into whatever framebuffer it is given: a picture in memory, or a window.
#pragma once

#include <cstddef>
#include <memory>

#include "render/image.hpp"
#include "render/scene.hpp"

namespace crumble::render {

/// Needs a current OpenGL 3.3 context, the same at every call and at destruction. Three passes: shadow map from the
/// light; surfaces at twice the width and height into key light, ambient light and normals; composition with ambient
/// occlusion, tone curve and the mean over 2 x 2 samples.
class Renderer {
 public:
  /// Throws Error(unsupported) when the driver refuses a shader.
  Renderer();
  ~Renderer();
  /// Into OpenGL framebuffer `framebuffer` (0: the window); leaves viewport, depth test, culling, program and bindings
  /// changed. Throws what check(scene) throws; width and height outside
  /// [1, 8192]: out_of_range.
  void draw(const Scene& scene, int width, int height, unsigned framebuffer);
  /// Into memory. Throws as above.
  Image draw(const Scene& scene, int width, int height);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace crumble::render
