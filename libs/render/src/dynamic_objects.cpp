// SPDX-License-Identifier: MIT
#include "dynamic_objects.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include <glm/gtc/matrix_transform.hpp>

#include "cube_faces.h"
#include "relume/core/error.h"

namespace relume::render {
namespace {

constexpr GLuint kCubeUnit = 12, kVolumeUnit = 13, kObjectBinding = 10;  // shaders/objects.glsl
constexpr int kCoefficients = 9, kCorners = 8;
constexpr std::uint32_t kProbeDirections = 64;

struct GpuObject {  // std430, shaders/objects.glsl
  Mat4 volume_from_world, world_from_start;
  Vec4 centre_occludes, box_lo, box_size;
  std::array<Vec4, kCorners * kCoefficients> harmonics;
};

/// Real spherical harmonics, bands 0 to 2, in the order of shaders/objects.glsl.
std::array<float, kCoefficients> harmonics(Direction d) {
  return {0.282095f,
          0.488603f * d.y,
          0.488603f * d.z,
          0.488603f * d.x,
          1.092548f * d.x * d.y,
          1.092548f * d.y * d.z,
          0.315392f * (3 * d.z * d.z - 1),
          1.092548f * d.x * d.z,
          0.546274f * (d.x * d.x - d.y * d.y)};
}

Direction fibonacci(std::uint32_t i, std::uint32_t count) {
  const float z = 1 - (2 * static_cast<float>(i) + 1) / static_cast<float>(count);
  const float sine = std::sqrt(std::max(0.0f, 1 - z * z)), phi = 2.39996323f * static_cast<float>(i);
  return {sine * std::cos(phi), sine * std::sin(phi), z};
}

}  // namespace

std::size_t DynamicObjects::add(const Object& object, const GpuScene& scene) {
  if (objects_.size() == kMost)
    throw Error(ErrorCode::kUsage, "objects", fmt::format("there are more than {}", kMost),
                "leave some out, or bake what stands still");
  const bool occludes = object.occlusion.side > 0;
  if (occludes && object.occlusion.side != kVolumeSide)
    throw Error(ErrorCode::kUsage, "occlusion of an object",
                fmt::format("has {} cells a side", object.occlusion.side),
                fmt::format("make it {}", kVolumeSide));
  Placed placed;
  placed.instances = object.instances;
  placed.occlusion = object.occlusion.box;
  placed.occludes = occludes;
  objects_.push_back(placed);
  volumes_.push_back(occludes ? object.occlusion.cells
                              : std::vector<Vec4>(kVolumeSide * kVolumeSide * kVolumeSide, Vec4(0)));
  harmonics_.emplace_back(kCorners * kCoefficients, Vec4(0));
  place(objects_.size() - 1, Mat4(1), scene);
  const auto count = static_cast<int>(objects_.size());
  volume_ = Texture::make3d(GL_RGBA16F, kVolumeSide, kVolumeSide, kVolumeSide * count);
  volume_.plain(true);
  for (int i = 0; i < count; ++i)
    glTextureSubImage3D(volume_.name(), 0, 0, 0, kVolumeSide * i, kVolumeSide, kVolumeSide, kVolumeSide,
                        GL_RGBA, GL_FLOAT, volumes_[static_cast<std::size_t>(i)].data());
  cubes_ = {};
  return objects_.size() - 1;
}

int DynamicObjects::objectOf(std::uint32_t instance) const {
  for (std::size_t i = 0; i < objects_.size(); ++i)
    if (std::find(objects_[i].instances.begin(), objects_[i].instances.end(), instance) !=
        objects_[i].instances.end())
      return static_cast<int>(i);
  return -1;
}

void DynamicObjects::place(std::size_t object, const Mat4& world_from_start, const GpuScene& scene) {
  Placed& o = objects_[object];
  o.world_from_start = world_from_start;
  o.box = {};
  for (const GpuScene::Drawn& d : scene.drawn())
    if (objectOf(d.instance) == static_cast<int>(object)) o.box.add(d.box);
  if (o.box.empty()) o.box = {Point(0), Point(0)};
  o.moved = stale_ = true;
}

void DynamicObjects::refreshCubes(bool all, const std::function<void(const Eye&)>& draw) {
  if (!cubes_) {
    cubes_ = Texture::makeCubeArray(GL_RGBA16F, kCubeSize, static_cast<int>(objects_.size()), true);
    cubes_.parameter(GL_TEXTURE_MIN_FILTER, GL_LINEAR_MIPMAP_LINEAR);
    depth_ = Texture::make2d(GL_DEPTH_COMPONENT32F, {kCubeSize, kCubeSize});
    target_ = Framebuffer::make();
    target_.attach(GL_DEPTH_ATTACHMENT, depth_);
    all = true;
  }
  bool any = false;
  for (std::size_t i = 0; i < objects_.size(); ++i) {
    Placed& o = objects_[i];
    if (!all && !o.moved) continue;
    any = true;
    o.moved = false;
    const Point centre = o.box.centre();
    // Depth 1 is near, 0 infinitely far.
    const float near = std::max(0.05f * o.box.diagonal(), 1e-3f);
    Mat4 projection(0.0f);
    projection[0][0] = projection[1][1] = 1, projection[2][3] = -1, projection[3][2] = near;
    for (int face = 0; face < 6; ++face) {
      const auto& [forward, up] = kCubeFaces[static_cast<std::size_t>(face)];
      target_.attachLayer(GL_COLOR_ATTACHMENT0, cubes_, 6 * static_cast<int>(i) + face);
      glBindFramebuffer(GL_FRAMEBUFFER, target_.name());
      glViewport(0, 0, kCubeSize, kCubeSize);
      draw({.clip_from_world = projection * glm::lookAt(centre, centre + forward, up),
            .position = centre,
            .forward = forward});
    }
  }
  if (any) glGenerateTextureMipmap(cubes_.name());
}

void DynamicObjects::refreshProbes(const std::function<Irradiance(Point, Normal)>& irradiance) {
  for (std::size_t i = 0; i < objects_.size(); ++i) {
    const Box3& box = objects_[i].box;
    std::fill(harmonics_[i].begin(), harmonics_[i].end(), Vec4(0));
    for (int corner = 0; corner < kCorners; ++corner) {
      const Point p(corner & 1 ? box.hi.x : box.lo.x, corner & 2 ? box.hi.y : box.lo.y,
                    corner & 4 ? box.hi.z : box.lo.z);
      for (std::uint32_t k = 0; k < kProbeDirections; ++k) {
        const Direction n = fibonacci(k, kProbeDirections);
        const Vec3 e = irradiance(p, n).rgb * (4 * kPi / static_cast<float>(kProbeDirections));
        const auto y = harmonics(n);
        for (int c = 0; c < kCoefficients; ++c)
          harmonics_[i][static_cast<std::size_t>(corner * kCoefficients + c)] +=
              Vec4(e * y[static_cast<std::size_t>(c)], 0);
      }
    }
  }
  stale_ = true;
}

void DynamicObjects::upload() {
  std::vector<GpuObject> packed(objects_.size());
  for (std::size_t i = 0; i < objects_.size(); ++i) {
    const Placed& o = objects_[i];
    GpuObject& g = packed[i];
    const Vec3 extent = glm::max(o.occlusion.extent(), Vec3(1e-6f));
    g.volume_from_world = glm::scale(Mat4(1), 1.0f / extent) * glm::translate(Mat4(1), -o.occlusion.lo) *
                          glm::inverse(o.world_from_start);
    g.world_from_start = o.world_from_start;
    g.centre_occludes = Vec4(o.box.centre(), o.occludes ? 1 : 0);
    g.box_lo = Vec4(o.box.lo, 0);
    g.box_size = Vec4(glm::max(o.box.extent(), Vec3(1e-6f)), 0);
    std::copy(harmonics_[i].begin(), harmonics_[i].end(), g.harmonics.begin());
  }
  buffer_.emplace(packed);
  stale_ = false;
}

void DynamicObjects::bind() {
  if (stale_) upload();
  buffer_->bindStorage(kObjectBinding);
  if (cubes_) cubes_.bind(kCubeUnit);
  volume_.bind(kVolumeUnit);
}

}  // namespace relume::render
