// SPDX-License-Identifier: MIT
// A scene on the device: vertices, materials, textures.
#pragma once
#include <cstdint>
#include <vector>

#include "gl_objects.h"
#include "relume/scene/scene.h"

namespace relume::render {

/// How textures are looked up between texels.
enum class TextureFilter : std::uint8_t {
  kMipmaps,  ///< trilinear, for one sample a pixel
  kBilinear  ///< of the finest level, as rays look them up; for pictures out of many samples
};

/// Whether a box may be seen through a clip matrix: not all of its corners lie beyond one of its side planes
/// or behind it.
bool mayBeSeen(const Box3& box, const Mat4& clip_from_world);

class GpuScene {
 public:
  explicit GpuScene(const scene::Scene& scene);

  /// An instance as it is drawn.
  struct Drawn {
    std::uint32_t instance, mesh, material;
    Mat4 world_from_local;
    Box3 box;  ///< world
    bool dynamic, translucent;
    bool mirrored;  ///< its transform turns insides out
    int page;       ///< of the atlas; -1: no bake
    bool tangents;
  };
  const std::vector<Drawn>& drawn() const { return drawn_; }
  /// Where an instance stands from now on.
  void place(std::size_t drawn, const Mat4& world_from_local);
  Box3 bounds() const;  ///< of all that is drawn

  void setFilter(TextureFilter filter);
  /// Binds vertices and materials (storage binding 0); before any draw().
  void bind() const;
  /// Draws one instance with `program` in use, whose uniforms u_world_from_local and u_material are set.
  void draw(const Drawn& what, const Program& program, bool all_textures) const;
  /// Whether its material has a height map.
  bool hasRelief(const Drawn& what) const { return slots_[what.material].relief != kNoRelief; }
  bool needsTextures(const Drawn& what) const { return alpha_tested_[what.material]; }

 private:
  struct Range {
    std::uint32_t first_index, indices;
    std::int32_t first_vertex;
  };
  struct Slots {
    std::uint32_t base, metallic_roughness, normal, emission;  // of textures_, the last one is white
    std::uint32_t relief;                                      // of reliefs_
  };

  void addRelief(const scene::Scene& scene, const scene::Material& material);
  Texture upload(const scene::Texture& texture);

  std::vector<Range> ranges_;  // by mesh
  std::vector<Box3> local_boxes_;
  std::vector<Drawn> drawn_;
  static constexpr std::uint32_t kNoRelief = 0xffffffffu;

  std::vector<Texture> textures_, reliefs_;
  std::vector<Slots> slots_;  // by material
  std::vector<bool> alpha_tested_;
  std::vector<std::uint8_t> double_sided_;
  Buffer vertices_, indices_, materials_;
  VertexArray array_;
};

}  // namespace relume::render
