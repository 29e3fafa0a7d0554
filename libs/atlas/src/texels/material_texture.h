// SPDX-License-Identifier: MIT
// What a material's textures say of albedo and opacity, pixel by pixel, and its means over 2 x 2, 4 x 4, ...
// pixels.
#pragma once
#include <array>
#include <cstdint>
#include <memory>
#include <mutex>
#include <vector>

#include "relume/scene/scene.h"

namespace relume::atlas {

/// Albedo (times opacity, which weighs it) and opacity in one image, so that its means are those of the
/// product: where a texture says rust and metal in turns, mean colour times mean share of metal is far off.
/// Levels are made when first asked for; from several threads at once.
class MaterialTexture {
 public:
  /// Whether `material` on this mesh can be read so: its textures lie pixel on pixel, none of them emits, and
  /// no vertex colour takes part in a decision about alpha.
  static bool possible(const scene::Scene& scene, const scene::Mesh& mesh, const scene::Material& material);

  MaterialTexture(const scene::Scene& scene, const scene::Material& material);

  const scene::TextureRef& mapping() const { return *mapping_; }  ///< from a mesh's uv to [0, 1) of the image
  double width() const { return static_cast<double>(width_); }
  double height() const { return static_cast<double>(height_); }

  /// The mean over the block of 2^level x 2^level pixels about `at`, in pixels of the image, wrapped: albedo
  /// times opacity without the material's factor, and opacity.
  Vec4 look(int level, glm::dvec2 at) const;

 private:
  using Pixel = std::array<std::uint16_t, 4>;  // of 65535
  struct Level {
    int width = 0;
    std::vector<Pixel> pixels;
  };

  Pixel pixel(int x, int y) const;
  void makeLevels() const;

  const scene::TextureRef* mapping_ = nullptr;
  scene::Wrap wrap_u_ = scene::Wrap::kRepeat, wrap_v_ = scene::Wrap::kRepeat;
  int width_ = 0, height_ = 0;
  const image::Image8 *colour_ = nullptr, *metal_ = nullptr;
  std::array<std::uint16_t, 256> linear_{};     // of colour's bytes
  std::array<std::uint16_t, 256> not_metal_{};  // 1 - metallic, of the blue byte
  std::array<std::uint16_t, 256> opacity_{};    // of the alpha byte
  bool has_opacity_ = false;
  mutable std::once_flag made_;
  mutable std::vector<Level> levels_;  // [0] is level 1
};

/// The textures of a scene's materials, each made when first needed. From several threads at once.
class MaterialTextures {
 public:
  explicit MaterialTextures(const scene::Scene& scene);
  /// Null where the material has none or is not possible.
  const MaterialTexture* of(const scene::Mesh& mesh) const;

 private:
  const scene::Scene& scene_;
  std::vector<std::unique_ptr<MaterialTexture>> by_material_;
};

}  // namespace relume::atlas
