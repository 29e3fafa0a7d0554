// SPDX-License-Identifier: MIT
// OpenGL objects that end with their scope. All of OpenGL 4.5 core, by direct state access; a context must be
// current when they are made, used and dropped.
#pragma once
#include <epoxy/gl.h>

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "relume/core/vec.h"

namespace relume::render {

/// A name of OpenGL's and how to give it back.
template <class Deleter>
class Handle {
 public:
  Handle() = default;
  explicit Handle(GLuint name) : name_(name) {}
  Handle(Handle&& other) noexcept : name_(std::exchange(other.name_, 0)) {}
  Handle& operator=(Handle&& other) noexcept {
    std::swap(name_, other.name_);
    return *this;
  }
  ~Handle() {
    if (name_) Deleter()(name_);
  }
  GLuint name() const { return name_; }
  explicit operator bool() const { return name_ != 0; }

 private:
  GLuint name_ = 0;
};

struct DeleteBuffer {
  void operator()(GLuint n) const { glDeleteBuffers(1, &n); }
};
struct DeleteTexture {
  void operator()(GLuint n) const { glDeleteTextures(1, &n); }
};
struct DeleteSampler {
  void operator()(GLuint n) const { glDeleteSamplers(1, &n); }
};
struct DeleteFramebuffer {
  void operator()(GLuint n) const { glDeleteFramebuffers(1, &n); }
};
struct DeleteVertexArray {
  void operator()(GLuint n) const { glDeleteVertexArrays(1, &n); }
};
struct DeleteProgram {
  void operator()(GLuint n) const { glDeleteProgram(n); }
};
struct DeleteQuery {
  void operator()(GLuint n) const { glDeleteQueries(1, &n); }
};

/// Memory on the device. An empty one has 16 bytes, so that it can be bound.
class Buffer : public Handle<DeleteBuffer> {
 public:
  Buffer() = default;
  explicit Buffer(std::size_t bytes, const void* data = nullptr);
  template <class T>
  explicit Buffer(const std::vector<T>& data) : Buffer(data.size() * sizeof(T), data.data()) {}

  std::size_t bytes() const { return bytes_; }
  void write(std::size_t offset, std::size_t bytes, const void* data);
  /// Waits for the device.
  void read(std::size_t offset, std::size_t bytes, void* data) const;
  void clear();  ///< to zero
  void bindStorage(GLuint binding) const { glBindBufferBase(GL_SHADER_STORAGE_BUFFER, binding, name()); }

 private:
  std::size_t bytes_ = 0;
};

class Texture : public Handle<DeleteTexture> {
 public:
  using Handle::Handle;
  /// One level, or as many as there are down to one texel; nothing in it yet.
  static Texture make2d(GLenum format, IVec2 size, bool mipmaps = false);
  static Texture makeArray(GLenum format, IVec2 size, int layers);
  static Texture makeCube(GLenum format, int size);
  static Texture makeCubeArray(GLenum format, int size, int cubes, bool mipmaps = false);
  static Texture make3d(GLenum format, int width, int height, int depth);
  void parameter(GLenum name, GLint value) { glTextureParameteri(this->name(), name, value); }
  /// Bilinear (or nearest) and clamped to its edge.
  void plain(bool linear);
  void bind(GLuint unit) const { glBindTextureUnit(unit, name()); }
};

class Framebuffer : public Handle<DeleteFramebuffer> {
 public:
  using Handle::Handle;
  static Framebuffer make();
  void attach(GLenum attachment, const Texture& texture) {
    glNamedFramebufferTexture(name(), attachment, texture.name(), 0);
  }
  void attachLayer(GLenum attachment, const Texture& texture, int layer) {
    glNamedFramebufferTextureLayer(name(), attachment, texture.name(), 0, layer);
  }
};

class VertexArray : public Handle<DeleteVertexArray> {
 public:
  using Handle::Handle;
  static VertexArray make();
};

/// A linked program out of the texts in shaders/.
class Program : public Handle<DeleteProgram> {
 public:
  Program() = default;
  /// `defines` stand before the text, e.g. "#define BITS 8\n". Throws Error kUnsupported with what the driver
  /// says of which line.
  static Program draw(const std::string& vertex, const std::string& fragment,
                      const std::string& defines = {});
  static Program compute(const std::string& shader, const std::string& defines = {});

  void use() const { glUseProgram(name()); }
  // Uniforms by name; one that the compiler dropped is no mistake.
  void set(const char* uniform, float v) const { glProgramUniform1f(name(), at(uniform), v); }
  void set(const char* uniform, int v) const { glProgramUniform1i(name(), at(uniform), v); }
  void set(const char* uniform, std::uint32_t v) const { glProgramUniform1ui(name(), at(uniform), v); }
  void set(const char* uniform, Vec2 v) const { glProgramUniform2f(name(), at(uniform), v.x, v.y); }
  void set(const char* uniform, Vec3 v) const { glProgramUniform3f(name(), at(uniform), v.x, v.y, v.z); }
  void set(const char* uniform, const Mat4& v) const {
    glProgramUniformMatrix4fv(name(), at(uniform), 1, GL_FALSE, &v[0][0]);
  }
  /// Runs a compute shader over at least `count` invocations of groups of `group`.
  void dispatch(std::size_t count, std::uint32_t group) const;

 private:
  explicit Program(GLuint n) : Handle(n) {}
  GLint at(const char* uniform) const { return glGetUniformLocation(name(), uniform); }
};

}  // namespace relume::render
