// SPDX-License-Identifier: MIT
#include "shadow_maps.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <glm/gtc/matrix_transform.hpp>

#include "cube_faces.h"
#include "relume/core/frame.h"

namespace relume::render {
namespace {

constexpr int kCubeUnit = 8, kPlaneUnit = 9;  // shaders/shadows.glsl
constexpr std::size_t kMomentBytes = 8;
constexpr int kLeastCube = 64;
constexpr int kStep = 16;  // texels; sides are whole steps

/// Of an empty scene some box.
Box3 boundsOf(const GpuScene& scene) {
  const Box3 box = scene.bounds();
  return box.empty() ? Box3{Point(-1), Point(1)} : box;
}

}  // namespace

ShadowMaps::ShadowMaps(const ShadowOptions& options)
    : options_(options),
      casters_(Program::draw("shadow.vert.glsl", "shadow.frag.glsl")),
      filter_cube_(Program::draw("fullscreen.vert.glsl", "shadow_filter.frag.glsl", "#define CUBE\n")),
      filter_plane_(Program::draw("fullscreen.vert.glsl", "shadow_filter.frag.glsl")),
      framebuffer_(Framebuffer::make()),
      target_(Framebuffer::make()),
      none_(VertexArray::make()),
      plane_buffer_(0) {}

std::vector<int> ShadowMaps::layers(const LightSet& lights, bool& all_anew) {
  int cubes = 0, planes = 0;
  std::vector<int> layer;
  for (const Light& light : lights)
    layer.push_back(light.kind == Light::Kind::kDirectional ? planes++ : cubes++);
  all_anew = false;
  if (planes > planes_ || !plane_maps_) {
    planes_ = std::max(planes, 1);
    all_anew = true;
    const int size = planes ? options_.plane_size : kStep;
    plane_maps_ = Texture::makeArray(GL_RG32F, {size, size}, planes_);
    plane_maps_.plain(true);
    plane_ = Texture::make2d(GL_RG32F, {size, size});
    plane_.plain(true);
    plane_depth_ = Texture::make2d(GL_DEPTH_COMPONENT32F, {size, size});
    plane_matrices_.assign(static_cast<std::size_t>(planes_), Mat4(1));
    plane_buffer_ = Buffer(plane_matrices_);
  }
  if (cubes > cubes_ || !cube_maps_) {
    cubes_ = std::max(cubes, 1);
    all_anew = true;
    const double texels = static_cast<double>(options_.most_bytes) / (kMomentBytes * 6.0 * (cubes_ + 2));
    const int fits = static_cast<int>(std::sqrt(texels)) / kStep * kStep;
    cube_size_ = std::clamp(fits, kLeastCube, std::max(options_.cube_size, kLeastCube));
    if (!cubes) cube_size_ = kStep;
    cube_maps_ = Texture::makeCubeArray(GL_RG32F, cube_size_, cubes_);
    cube_ = Texture::makeCube(GL_RG32F, cube_size_);
    cube_depth_ = Texture::make2d(GL_DEPTH_COMPONENT32F, {cube_size_, cube_size_});
  }
  return layer;
}

void ShadowMaps::draw(const GpuScene& scene, const Light& light, Point origin, int layer) {
  glEnable(GL_DEPTH_TEST);
  glDisable(GL_BLEND);
  glDisable(GL_CULL_FACE);
  glClipControl(GL_LOWER_LEFT, GL_NEGATIVE_ONE_TO_ONE);
  glDepthFunc(GL_LESS);
  glDepthMask(GL_TRUE);
  if (light.kind == Light::Kind::kDirectional)
    drawPlane(scene, light.direction, layer);
  else
    drawCube(scene, origin, layer);
}

void ShadowMaps::drawCasters(const GpuScene& scene, const Mat4& clip_from_world, float beyond,
                             bool perspective) {
  const std::array<GLfloat, 4> nothing = {beyond, beyond * beyond, 0, 0};
  constexpr GLfloat kClear = 1.0f;
  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer_.name());
  glClearBufferfv(GL_COLOR, 0, nothing.data());
  glClearBufferfv(GL_DEPTH, 0, &kClear);
  // Before a directional light's plane nothing is cut off.
  perspective ? glDisable(GL_DEPTH_CLAMP) : glEnable(GL_DEPTH_CLAMP);
  casters_.use();
  casters_.set("u_clip_from_world", clip_from_world);
  scene.bind();
  for (const GpuScene::Drawn& d : scene.drawn())
    if (mayBeSeen(d.box, clip_from_world)) scene.draw(d, casters_, false);
  glDisable(GL_DEPTH_CLAMP);
}

void ShadowMaps::drawCube(const GpuScene& scene, Point origin, int layer) {
  const Box3 box = boundsOf(scene);
  float far = 1e-3f;
  for (int k = 0; k < 8; ++k)
    far = std::max(far, glm::length(Point(k & 1 ? box.hi.x : box.lo.x, k & 2 ? box.hi.y : box.lo.y,
                                          k & 4 ? box.hi.z : box.lo.z) -
                                    origin));
  // What a lamp is made of begins about here, and should not hide it.
  const float near = std::clamp(1e-4f * far, 1e-3f, 0.02f);
  const Mat4 projection = glm::perspective(0.5f * kPi, 1.0f, near, 1.01f * far);
  glViewport(0, 0, cube_size_, cube_size_);
  glProgramUniform4f(casters_.name(), glGetUniformLocation(casters_.name(), "u_light"), origin.x, origin.y,
                     origin.z, 1.0f);
  for (int face = 0; face < 6; ++face) {
    const auto& [forward, up] = kCubeFaces[static_cast<std::size_t>(face)];
    framebuffer_.attachLayer(GL_COLOR_ATTACHMENT0, cube_, face);
    framebuffer_.attach(GL_DEPTH_ATTACHMENT, cube_depth_);
    drawCasters(scene, projection * glm::lookAt(origin, origin + forward, up), 1.5f * far, true);
  }
  for (int face = 0; face < 6; ++face) {
    filter_cube_.set("u_face", face);
    filterInto(filter_cube_, cube_, cube_maps_, 6 * layer + face, cube_size_);
  }
}

void ShadowMaps::drawPlane(const GpuScene& scene, Direction direction, int layer) {
  const Box3 box = boundsOf(scene);
  const Frame frame = Frame::about(direction);
  Vec3 lo(kInfinity), hi(-kInfinity);
  for (int k = 0; k < 8; ++k) {
    const Point p(k & 1 ? box.hi.x : box.lo.x, k & 2 ? box.hi.y : box.lo.y, k & 4 ? box.hi.z : box.lo.z);
    const Vec3 q(glm::dot(p, frame.t), glm::dot(p, frame.b), glm::dot(p, direction));
    lo = glm::min(lo, q), hi = glm::max(hi, q);
  }
  const Vec3 margin = 0.01f * (hi - lo) + Vec3(1e-3f);
  lo -= margin, hi += margin;
  const Vec3 size = hi - lo;
  // Rows: texture coordinates of the map, and metres from its plane.
  Mat4& map = plane_matrices_[static_cast<std::size_t>(layer)];
  map = glm::transpose(Mat4(Vec4(frame.t / size.x, -lo.x / size.x), Vec4(frame.b / size.y, -lo.y / size.y),
                            Vec4(direction, -lo.z), Vec4(0, 0, 0, 1)));
  plane_buffer_.write(0, plane_matrices_.size() * sizeof(Mat4), plane_matrices_.data());
  const Mat4 clip_from_map = glm::transpose(
      Mat4(Vec4(2, 0, 0, -1), Vec4(0, 2, 0, -1), Vec4(0, 0, 2 / size.z, -1), Vec4(0, 0, 0, 1)));
  glProgramUniform4f(casters_.name(), glGetUniformLocation(casters_.name(), "u_light"), direction.x,
                     direction.y, direction.z, 0.0f);
  casters_.set("u_plane_start", lo.z);
  framebuffer_.attach(GL_COLOR_ATTACHMENT0, plane_);
  framebuffer_.attach(GL_DEPTH_ATTACHMENT, plane_depth_);
  glViewport(0, 0, options_.plane_size, options_.plane_size);
  drawCasters(scene, clip_from_map * map, 1.5f * size.z, false);
  filterInto(filter_plane_, plane_, plane_maps_, layer, options_.plane_size);
}

void ShadowMaps::filterInto(const Program& program, const Texture& source, const Texture& target, int layer,
                            int size) {
  target_.attachLayer(GL_COLOR_ATTACHMENT0, target, layer);
  glBindFramebuffer(GL_FRAMEBUFFER, target_.name());
  glDisable(GL_DEPTH_TEST);
  glEnable(GL_TEXTURE_CUBE_MAP_SEAMLESS);
  source.bind(0);
  program.set("u_texel", 1.0f / static_cast<float>(size));
  program.set("u_radius", options_.filter);
  program.use();
  glBindVertexArray(none_.name());
  glDrawArrays(GL_TRIANGLES, 0, 3);
  glEnable(GL_DEPTH_TEST);
}

void ShadowMaps::bind(const Program& program) const {
  glEnable(GL_TEXTURE_CUBE_MAP_SEAMLESS);
  cube_maps_.bind(kCubeUnit);
  plane_maps_.bind(kPlaneUnit);
  plane_buffer_.bindStorage(9);
  program.set("u_cube_texel", 2.0f / static_cast<float>(std::max(cube_size_, 1)));
  program.set("u_bleeding", options_.bleeding);
}

}  // namespace relume::render
