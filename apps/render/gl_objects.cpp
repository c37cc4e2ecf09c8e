#include "render/gl_objects.hpp"

#include <string>

#include "crumble/base/error.hpp"
#include "crumble/base/memory.hpp"

namespace crumble::render {
namespace {

Shader compile(GLenum stage, const char* source) {
  Shader shader(glCreateShader(stage));
  glShaderSource(shader.get(), 1, &source, nullptr);
  glCompileShader(shader.get());
  GLint is_good = 0;
  glGetShaderiv(shader.get(), GL_COMPILE_STATUS, &is_good);
  if (!is_good) {
    char log[1024] = "";
    glGetShaderInfoLog(shader.get(), sizeof log, nullptr, log);
    throw Error(Code::unsupported, std::string("the OpenGL driver refuses a shader: ") + log);
  }
  return shader;
}

}  // namespace

Program::Program(const char* vertex_source, const char* fragment_source) : name_(glCreateProgram()) {
  const Shader vertex = compile(GL_VERTEX_SHADER, vertex_source);
  const Shader fragment = compile(GL_FRAGMENT_SHADER, fragment_source);
  glAttachShader(name_.get(), vertex.get());
  glAttachShader(name_.get(), fragment.get());
  glLinkProgram(name_.get());
  GLint is_good = 0;
  glGetProgramiv(name_.get(), GL_LINK_STATUS, &is_good);
  if (!is_good) {
    char log[1024] = "";
    glGetProgramInfoLog(name_.get(), sizeof log, nullptr, log);
    throw Error(Code::unsupported, std::string("the OpenGL driver cannot link a program: ") + log);
  }
}

void Program::set(const char* name, const Vec3& value) const {
  glUniform3f(at(name), static_cast<float>(value.x()), static_cast<float>(value.y()), static_cast<float>(value.z()));
}

Texture make_texture(GLenum internal_format, GLenum format, int width, int height) {
  GLuint name = 0;
  glGenTextures(1, &name);
  Texture texture(name);
  glBindTexture(GL_TEXTURE_2D, name);
  glTexImage2D(GL_TEXTURE_2D, 0, static_cast<GLint>(internal_format), width, height, 0, format, GL_FLOAT, nullptr);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
  return texture;
}

Framebuffer make_framebuffer(std::initializer_list<GLuint> colours, GLuint depth) {
  GLuint name = 0;
  glGenFramebuffers(1, &name);
  Framebuffer framebuffer(name);
  glBindFramebuffer(GL_FRAMEBUFFER, name);
  Vector<GLenum> targets;
  for (const GLuint colour : colours) {
    targets.push_back(static_cast<GLenum>(GL_COLOR_ATTACHMENT0 + targets.size()));
    glFramebufferTexture2D(GL_FRAMEBUFFER, targets.back(), GL_TEXTURE_2D, colour, 0);
  }
  if (depth != 0) glFramebufferTexture2D(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_TEXTURE_2D, depth, 0);
  if (targets.empty()) {
    glDrawBuffer(GL_NONE);
    glReadBuffer(GL_NONE);
  } else {
    glDrawBuffers(static_cast<GLsizei>(targets.size()), targets.data());
  }
  const GLenum status = glCheckFramebufferStatus(GL_FRAMEBUFFER);
  if (status != GL_FRAMEBUFFER_COMPLETE) {
    throw Error(Code::unsupported, "the OpenGL driver refuses a framebuffer: status " + std::to_string(status));
  }
  return framebuffer;
}

Buffer make_buffer() {
  GLuint name = 0;
  glGenBuffers(1, &name);
  return Buffer(name);
}

VertexArray make_vertex_array() {
  GLuint name = 0;
  glGenVertexArrays(1, &name);
  return VertexArray(name);
}

}  // namespace crumble::render
