// SPDX-License-Identifier: MIT
#include "gl_objects.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>

#include "relume/core/error.h"
#include "shader_text.h"

namespace relume::render {

Buffer::Buffer(std::size_t bytes, const void* data) : bytes_(bytes) {
  GLuint name = 0;
  glCreateBuffers(1, &name);
  static_cast<Handle&>(*this) = Handle(name);
  constexpr std::size_t kLeast = 16;
  glGetError();
  glNamedBufferStorage(name, static_cast<GLsizeiptr>(std::max(bytes, kLeast)),
                       bytes < kLeast ? nullptr : data, GL_DYNAMIC_STORAGE_BIT);
  if (glGetError() == GL_OUT_OF_MEMORY)
    throw Error(ErrorCode::kOutOfMemory, "the graphics device",
                fmt::format("has no room for a buffer of {} MiB", bytes >> 20),
                "take --renderer cpu, or bake a smaller atlas");
  if (bytes && bytes < kLeast && data) write(0, bytes, data);
}

void Buffer::write(std::size_t offset, std::size_t bytes, const void* data) {
  if (bytes)
    glNamedBufferSubData(name(), static_cast<GLintptr>(offset), static_cast<GLsizeiptr>(bytes), data);
}

void Buffer::read(std::size_t offset, std::size_t bytes, void* data) const {
  glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
  if (bytes)
    glGetNamedBufferSubData(name(), static_cast<GLintptr>(offset), static_cast<GLsizeiptr>(bytes), data);
}

void Buffer::clear() {
  const GLuint zero = 0;
  glClearNamedBufferData(name(), GL_R32UI, GL_RED_INTEGER, GL_UNSIGNED_INT, &zero);
}

namespace {

GLuint createTexture(GLenum target) {
  GLuint name = 0;
  glCreateTextures(target, 1, &name);
  return name;
}

}  // namespace

Texture Texture::make2d(GLenum format, IVec2 size, bool mipmaps) {
  Texture t(createTexture(GL_TEXTURE_2D));
  const int levels =
      mipmaps ? static_cast<int>(std::bit_width(static_cast<unsigned>(std::max(size.x, size.y)))) : 1;
  glTextureStorage2D(t.name(), levels, format, size.x, size.y);
  return t;
}

Texture Texture::makeArray(GLenum format, IVec2 size, int layers) {
  Texture t(createTexture(GL_TEXTURE_2D_ARRAY));
  glTextureStorage3D(t.name(), 1, format, size.x, size.y, layers);
  return t;
}

Texture Texture::makeCube(GLenum format, int size) {
  Texture t(createTexture(GL_TEXTURE_CUBE_MAP));
  glTextureStorage2D(t.name(), 1, format, size, size);
  t.plain(true);
  return t;
}

Texture Texture::makeCubeArray(GLenum format, int size, int cubes, bool mipmaps) {
  Texture t(createTexture(GL_TEXTURE_CUBE_MAP_ARRAY));
  const int levels = mipmaps ? static_cast<int>(std::bit_width(static_cast<unsigned>(size))) : 1;
  glTextureStorage3D(t.name(), levels, format, size, size, 6 * cubes);
  t.plain(true);
  return t;
}

Texture Texture::make3d(GLenum format, int width, int height, int depth) {
  Texture t(createTexture(GL_TEXTURE_3D));
  glTextureStorage3D(t.name(), 1, format, width, height, depth);
  return t;
}

void Texture::plain(bool linear) {
  parameter(GL_TEXTURE_MIN_FILTER, linear ? GL_LINEAR : GL_NEAREST);
  parameter(GL_TEXTURE_MAG_FILTER, linear ? GL_LINEAR : GL_NEAREST);
  parameter(GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
  parameter(GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
  parameter(GL_TEXTURE_WRAP_R, GL_CLAMP_TO_EDGE);
}

Framebuffer Framebuffer::make() {
  GLuint name = 0;
  glCreateFramebuffers(1, &name);
  return Framebuffer(name);
}

VertexArray VertexArray::make() {
  GLuint name = 0;
  glCreateVertexArrays(1, &name);
  return VertexArray(name);
}

namespace {

std::string logOf(GLuint object, bool program) {
  GLint length = 0;
  program ? glGetProgramiv(object, GL_INFO_LOG_LENGTH, &length)
          : glGetShaderiv(object, GL_INFO_LOG_LENGTH, &length);
  std::string log(static_cast<std::size_t>(std::max(length, 1)), '\0');
  program ? glGetProgramInfoLog(object, length, nullptr, log.data())
          : glGetShaderInfoLog(object, length, nullptr, log.data());
  while (!log.empty() && (log.back() == '\0' || log.back() == '\n')) log.pop_back();
  std::replace(log.begin(), log.end(), '\n', ' ');
  return log;
}

[[noreturn]] void refused(const std::string& name, const std::string& log) {
  const auto* driver = reinterpret_cast<const char*>(glGetString(GL_RENDERER));
  throw Error(ErrorCode::kUnsupported, "shader " + name,
              fmt::format("was refused by {}: {}", driver ? driver : "the driver", log),
              "update the graphics driver, or take --renderer cpu");
}

GLuint compile(GLenum stage, const std::string& name, const std::string& defines) {
  const std::string text = shaderText(name, defines);
  const GLuint shader = glCreateShader(stage);
  const char* source = text.c_str();
  glShaderSource(shader, 1, &source, nullptr);
  glCompileShader(shader);
  GLint sound = 0;
  glGetShaderiv(shader, GL_COMPILE_STATUS, &sound);
  if (sound) return shader;
  const std::string log = logOf(shader, false);
  glDeleteShader(shader);
  refused(name, log);
}

void link(GLuint program, std::span<const GLuint> shaders, const std::string& name) {
  for (const GLuint s : shaders) glAttachShader(program, s);
  glLinkProgram(program);
  for (const GLuint s : shaders) glDetachShader(program, s), glDeleteShader(s);
  GLint sound = 0;
  glGetProgramiv(program, GL_LINK_STATUS, &sound);
  if (!sound) refused(name, logOf(program, true));
}

}  // namespace

Program Program::draw(const std::string& vertex, const std::string& fragment, const std::string& defines) {
  Program p(glCreateProgram());
  const GLuint v = compile(GL_VERTEX_SHADER, vertex, defines);
  const GLuint shaders[] = {v, compile(GL_FRAGMENT_SHADER, fragment, defines)};
  link(p.name(), shaders, fragment);
  return p;
}

Program Program::compute(const std::string& shader, const std::string& defines) {
  Program p(glCreateProgram());
  const GLuint shaders[] = {compile(GL_COMPUTE_SHADER, shader, defines)};
  link(p.name(), shaders, shader);
  return p;
}

void Program::dispatch(std::size_t count, std::uint32_t group) const {
  if (count == 0) return;
  use();
  // More groups than one dimension takes go on in the second; shaders count them together.
  constexpr std::size_t kMostGroups = 65535;
  const std::size_t groups = (count + group - 1) / group;
  const std::size_t rows = (groups + kMostGroups - 1) / kMostGroups;
  glDispatchCompute(static_cast<GLuint>((groups + rows - 1) / rows), static_cast<GLuint>(rows), 1);
}

}  // namespace relume::render
