// SPDX-License-Identifier: MIT
// Light on things that move, and what they hide of others. Based on:
//   [SKALP05] Szirmay-Kalos, Aszodi, Lazanyi, Premecz. Approximate Ray-Tracing on the GPU with Distance
//   Impostors. 2005: where a ray from elsewhere than its middle meets a cube map.
//   [SKL06] Szirmay-Kalos, Lazanyi. Indirect Diffuse and Glossy Illumination on the GPU. 2006: diffuse light
//   from the texels of a small cube map as so many area lights. [MMAH07] Malmer et al. Fast Precomputed
//   Ambient Occlusion for Proximity Shadows. 2007.
// Differs: distances are kept as their inverses, so that what is nowhere is 0 and means are benign.
#pragma once
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "gl_objects.h"
#include "gpu_scene.h"
#include "relume/core/quantity.h"
#include "relume/render/objects.h"
#include "surface_pass.h"

namespace relume::render {

class DynamicObjects {
 public:
  static constexpr std::size_t kMost = 8;
  static constexpr int kCubeSize = 64, kVolumeSide = 16;

  /// Throws Error kUsage for more objects than kMost, or an occlusion volume of another size.
  std::size_t add(const Object& object, const GpuScene& scene);
  bool empty() const { return objects_.empty(); }
  std::size_t size() const { return objects_.size(); }
  /// Which object an instance belongs to; -1: none.
  int objectOf(std::uint32_t instance) const;
  std::span<const std::uint32_t> instances(std::size_t object) const { return objects_[object].instances; }
  const Mat4& placeOf(std::size_t object) const { return objects_[object].world_from_start; }
  void place(std::size_t object, const Mat4& world_from_start, const GpuScene& scene);
  Box3 boxOf(std::size_t object) const { return objects_[object].box; }

  /// Draws the cube maps that are out of date: of objects that moved, or of all. `draw` shows the standing
  /// world from an eye, into the framebuffer that is bound.
  void refreshCubes(bool all, const std::function<void(const Eye&)>& draw);
  /// Irradiance at a place of the world facing a way, sampled at the corners of each object's box.
  void refreshProbes(const std::function<Irradiance(Point, Normal)>& irradiance);
  /// Binds what shaders/objects.glsl reads.
  void bind();

 private:
  struct Placed {
    std::vector<std::uint32_t> instances;
    Mat4 world_from_start{1.0f};
    Box3 box;        ///< world, now
    Box3 occlusion;  ///< where it stood at first
    bool moved = true, occludes = false;
  };
  void upload();

  std::vector<Placed> objects_;
  std::vector<std::vector<Vec4>> harmonics_;  // [object][corner][coefficient]
  std::vector<std::vector<Vec4>> volumes_;    // [object][z][y][x]
  Texture cubes_, depth_, volume_;
  Framebuffer target_;
  std::optional<Buffer> buffer_;
  bool stale_ = true;
};

}  // namespace relume::render
