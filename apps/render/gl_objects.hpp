// OpenGL names that delete themselves, and the few calls that make them.
#pragma once

#include <epoxy/gl.h>

#include <initializer_list>
#include <utility>

#include "crumble/base/vec.hpp"
#include "render/camera.hpp"

namespace crumble::render {

/// Owns one OpenGL name; `Delete` frees it in the context that is current then.
template <void (*Delete)(GLuint)>
class GlName {
 public:
  GlName() = default;
  explicit GlName(GLuint name) : name_(name) {}
  GlName(GlName&& other) noexcept : name_(std::exchange(other.name_, 0)) {}
  GlName& operator=(GlName&& other) noexcept {
    std::swap(name_, other.name_);
    return *this;
  }
  ~GlName() {
    if (name_ != 0) Delete(name_);
  }
  GLuint get() const { return name_; }

 private:
  GLuint name_ = 0;
};

inline void delete_buffer(GLuint name) {
  glDeleteBuffers(1, &name);
}
inline void delete_framebuffer(GLuint name) {
  glDeleteFramebuffers(1, &name);
}
inline void delete_program(GLuint name) {
  glDeleteProgram(name);
}
inline void delete_sampler(GLuint name) {
  glDeleteSamplers(1, &name);
}
inline void delete_shader(GLuint name) {
  glDeleteShader(name);
}
inline void delete_texture(GLuint name) {
  glDeleteTextures(1, &name);
}
inline void delete_vertex_array(GLuint name) {
  glDeleteVertexArrays(1, &name);
}

using Buffer = GlName<delete_buffer>;
using Framebuffer = GlName<delete_framebuffer>;
using Sampler = GlName<delete_sampler>;
using Shader = GlName<delete_shader>;
using Texture = GlName<delete_texture>;
using VertexArray = GlName<delete_vertex_array>;

/// A linked program; set() needs it to be in use.
class Program {
 public:
  Program() = default;
  /// Throws Error(unsupported) with the driver's log when it does not compile or link.
  Program(const char* vertex_source, const char* fragment_source);
  void use() const { glUseProgram(name_.get()); }
  void set(const char* name, int value) const { glUniform1i(at(name), value); }
  void set(const char* name, double value) const { glUniform1f(at(name), static_cast<float>(value)); }
  void set(const char* name, const Vec3& value) const;
  void set(const char* name, const Mat4& value) const { glUniformMatrix4fv(at(name), 1, GL_FALSE, value.data()); }

 private:
  GLint at(const char* name) const { return glGetUniformLocation(name_.get(), name); }
  GlName<delete_program> name_;
};

/// One level, nearest, clamped to the edge.
Texture make_texture(GLenum internal_format, GLenum format, int width, int height);
/// Throws Error(unsupported) when the driver calls the combination incomplete.
Framebuffer make_framebuffer(std::initializer_list<GLuint> colours, GLuint depth);
Buffer make_buffer();
VertexArray make_vertex_array();

}  // namespace crumble::render
