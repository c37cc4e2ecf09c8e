#include "render/offscreen_context.hpp"

#include <epoxy/egl.h>

#include <cstdio>
#include <string>

#include "crumble/base/error.hpp"

namespace crumble::render {
namespace {

[[noreturn]] void fail(const std::string& call) {
  char code[16];
  std::snprintf(code, sizeof code, "0x%04x", static_cast<unsigned>(eglGetError()));
  throw Error(Code::unsupported, "no off-screen OpenGL 3.3: " + call + " failed with EGL error " + code +
                                     " (Debian packages libegl1 and libgl1-mesa-dri give a software one)");
}

EGLDisplay open_display() {
  // Without this question epoxy would abort on a library that does not know the call.
  if (!epoxy_has_egl_extension(EGL_NO_DISPLAY, "EGL_EXT_platform_base") ||
      !epoxy_has_egl_extension(EGL_NO_DISPLAY, "EGL_MESA_platform_surfaceless")) {
    fail("the look-up of EGL_MESA_platform_surfaceless");
  }
  const EGLDisplay display = eglGetPlatformDisplayEXT(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, nullptr);
  if (display == EGL_NO_DISPLAY) fail("eglGetPlatformDisplay");
  if (!eglInitialize(display, nullptr, nullptr)) fail("eglInitialize");
  return display;
}

EGLContext make_context(EGLDisplay display) {
  if (!eglBindAPI(EGL_OPENGL_API)) fail("eglBindAPI");
  const EGLint wanted[] = {
      EGL_CONTEXT_MAJOR_VERSION,           3,       EGL_CONTEXT_MINOR_VERSION, 3, EGL_CONTEXT_OPENGL_PROFILE_MASK,
      EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT, EGL_NONE};
  const EGLContext context = eglCreateContext(display, EGL_NO_CONFIG_KHR, EGL_NO_CONTEXT, wanted);
  if (context == EGL_NO_CONTEXT) fail("eglCreateContext");
  if (!eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, context)) {
    eglDestroyContext(display, context);
    fail("eglMakeCurrent");
  }
  return context;
}

}  // namespace

OffscreenContext::OffscreenContext() : display_(open_display()), context_(make_context(display_)) {}

OffscreenContext::~OffscreenContext() {
  // The display stays initialised: EGL has one per process, and another context may be using it.
  eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
  eglDestroyContext(display_, context_);
}

}  // namespace crumble::render
