// An OpenGL context without window or X server, by EGL's surfaceless platform (Mesa; llvmpipe where there is no GPU).
#pragma once

namespace crumble::render {

/// OpenGL 3.3 core, current on the thread that made it until it is destroyed.
class OffscreenContext {
 public:
  /// Throws Error(unsupported) with EGL's own error when the system offers no such context.
  OffscreenContext();
  ~OffscreenContext();
  OffscreenContext(const OffscreenContext&) = delete;
  OffscreenContext& operator=(const OffscreenContext&) = delete;

 private:
  void* display_ = nullptr;  // EGLDisplay
  void* context_ = nullptr;  // EGLContext
};

}  // namespace crumble::render
