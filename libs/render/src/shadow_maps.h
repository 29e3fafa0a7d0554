// SPDX-License-Identifier: MIT
// Variance shadow maps of all lights: a cube for each point, spot and area light, a square over the whole
// scene for each directional one. Based on:
//   [DL06] Donnelly, Lauritzen. Variance Shadow Maps. 2006.
//   [Lau07] Lauritzen. Summed-Area Variance Shadow Maps. GPU Gems 3, ch. 8. 2007: light bleeding, slopes.
// An area light casts shadows from one point, whichever `origin` says: pictures out of many samples take
// many.
#pragma once
#include <cstdint>
#include <vector>

#include "gl_objects.h"
#include "gpu_scene.h"
#include "relume/core/light.h"
#include "relume/render/renderer.h"

namespace relume::render {

class ShadowMaps {
 public:
  explicit ShadowMaps(const ShadowOptions& options);

  /// Room for maps of these lights. Returns their layers, by light; and whether all maps have to be drawn
  /// anew.
  std::vector<int> layers(const LightSet& lights, bool& all_anew);
  /// Draws the map of one light, seen from `origin` (directional: anywhere).
  void draw(const GpuScene& scene, const Light& light, Point origin, int layer);
  /// Binds maps and sets what shaders/shadows.glsl asks for.
  void bind(const Program& program) const;
  int cubeSize() const { return cube_size_; }

 private:
  void drawCube(const GpuScene& scene, Point origin, int layer);
  void drawPlane(const GpuScene& scene, Direction direction, int layer);
  void drawCasters(const GpuScene& scene, const Mat4& clip_from_world, float beyond, bool perspective);
  void filterInto(const Program& program, const Texture& source, const Texture& target, int layer, int size);

  ShadowOptions options_;
  int cube_size_ = 0, cubes_ = 0, planes_ = 0;
  Program casters_, filter_cube_, filter_plane_;
  Texture cube_, cube_depth_, cube_maps_, plane_, plane_depth_, plane_maps_;
  Framebuffer framebuffer_, target_;
  VertexArray none_;
  std::vector<Mat4> plane_matrices_;
  Buffer plane_buffer_;
};

}  // namespace relume::render
