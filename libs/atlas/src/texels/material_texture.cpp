// SPDX-License-Identifier: MIT
#include "texels/material_texture.h"

#include <algorithm>
#include <cmath>

#include "relume/image/image.h"

namespace relume::atlas {
namespace {

bool readable(const scene::Scene& scene, const scene::TextureRef& ref) {
  return ref && scene.textures[ref.texture].image && !scene.textures[ref.texture].image->data.empty();
}

bool usesMetalMap(const scene::Scene& scene, const scene::Material& material) {
  return material.metallic > 0 && readable(scene, material.metallic_roughness_texture);
}

bool samePlaces(const scene::Scene& scene, const scene::TextureRef& a, const scene::TextureRef& b) {
  const scene::Texture &ta = scene.textures[a.texture], &tb = scene.textures[b.texture];
  return a.uv_set == b.uv_set && a.offset == b.offset && a.scale == b.scale && a.rotation == b.rotation &&
         ta.wrap_u == tb.wrap_u && ta.wrap_v == tb.wrap_v && ta.image->width == tb.image->width &&
         ta.image->height == tb.image->height;
}

std::uint16_t rounded(float share) {
  return static_cast<std::uint16_t>(std::lround(std::clamp(share, 0.0f, 1.0f) * 65535.0f));
}

std::uint16_t product(std::uint32_t a, std::uint32_t b) {
  return static_cast<std::uint16_t>((a * b + 32767u) / 65535u);
}

/// The pixel of [0, size) that a place falls into.
int wrapped(double at, int size, scene::Wrap wrap) {
  const double whole = size;
  if (at >= 0 && at < whole) return static_cast<int>(at);
  if (!std::isfinite(at)) return 0;
  if (wrap == scene::Wrap::kRepeat) {
    at -= whole * std::floor(at / whole);
  } else if (wrap == scene::Wrap::kMirror) {
    at -= 2 * whole * std::floor(at / (2 * whole));
    if (at >= whole) at = 2 * whole - at;
  }
  return static_cast<int>(std::clamp(at, 0.0, whole - 1));
}

}  // namespace

bool MaterialTexture::possible(const scene::Scene& scene, const scene::Mesh& mesh,
                               const scene::Material& material) {
  const scene::TextureRef &colour = material.base_colour_texture,
                          &metal = material.metallic_roughness_texture;
  if (material.unlit || !readable(scene, colour) || colour.uv_set >= mesh.uv.size() ||
      mesh.uv[colour.uv_set].empty())
    return false;
  if (material.emission != Vec3(0) && readable(scene, material.emission_texture)) return false;
  if (usesMetalMap(scene, material) && !samePlaces(scene, colour, metal)) return false;
  return material.alpha_mode == scene::AlphaMode::kOpaque || mesh.colours.empty();
}

MaterialTexture::MaterialTexture(const scene::Scene& scene, const scene::Material& material)
    : mapping_(&material.base_colour_texture) {
  const scene::Texture& texture = scene.textures[mapping_->texture];
  wrap_u_ = texture.wrap_u, wrap_v_ = texture.wrap_v;
  colour_ = texture.image.get();
  width_ = colour_->width, height_ = colour_->height;
  if (usesMetalMap(scene, material))
    metal_ = scene.textures[material.metallic_roughness_texture.texture].image.get();
  has_opacity_ = material.alpha_mode != scene::AlphaMode::kOpaque;
  for (std::size_t i = 0; i < 256; ++i) {
    const float share = static_cast<float>(i) / 255.0f, alpha = material.base_colour.a * share;
    linear_[i] = rounded(texture.srgb ? image::srgbToLinear(share) : share);
    not_metal_[i] = rounded(1.0f - material.metallic * (metal_ != nullptr ? share : 1.0f));
    opacity_[i] = material.alpha_mode == scene::AlphaMode::kMask
                      ? rounded(alpha >= material.alpha_cutoff ? 1.0f : 0.0f)
                      : rounded(alpha);
  }
}

MaterialTexture::Pixel MaterialTexture::pixel(int x, int y) const {
  const auto at =
      static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) + static_cast<std::size_t>(x);
  const auto channels = static_cast<std::size_t>(colour_->channels);
  const unsigned char* c = &colour_->data[at * channels];
  Pixel pixel{linear_[c[0]], linear_[c[channels < 3 ? 0 : 1]], linear_[c[channels < 3 ? 0 : 2]], 65535};
  std::uint32_t share = not_metal_[255];
  if (metal_ != nullptr) {  // blue, or grey
    const auto n = static_cast<std::size_t>(metal_->channels);
    share = not_metal_[metal_->data[at * n + (n < 3 ? 0 : 2)]];
  }
  if (has_opacity_) {
    pixel[3] = opacity_[channels == 2 ? c[1] : channels == 4 ? c[3] : 255];
    share = product(share, pixel[3]);
  }
  if (share != 65535)
    for (std::size_t k = 0; k < 3; ++k) pixel[k] = product(pixel[k], share);
  return pixel;
}

void MaterialTexture::makeLevels() const {
  int width = width_, height = height_;
  while (width > 1 || height > 1) {
    const Level* finer = levels_.empty() ? nullptr : &levels_.back();
    const auto from = [&](int x, int y) {
      return finer != nullptr ? finer->pixels[static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
                                              static_cast<std::size_t>(x)]
                              : pixel(x, y);
    };
    Level level;
    level.width = (width + 1) / 2;
    const int rows = (height + 1) / 2;
    level.pixels.resize(static_cast<std::size_t>(level.width) * static_cast<std::size_t>(rows));
    Pixel* out = level.pixels.data();
    for (int y = 0; y < rows; ++y) {
      // The last row or column of an odd number counts twice.
      const int y0 = 2 * y, y1 = std::min(2 * y + 1, height - 1);
      for (int x = 0; x < level.width; ++x, ++out) {
        const int x0 = 2 * x, x1 = std::min(2 * x + 1, width - 1);
        const Pixel a = from(x0, y0), b = from(x1, y0), c = from(x0, y1), d = from(x1, y1);
        for (std::size_t k = 0; k < 4; ++k)
          (*out)[k] = static_cast<std::uint16_t>((std::uint32_t{a[k]} + b[k] + c[k] + d[k] + 2) / 4);
      }
    }
    width = level.width, height = rows;
    levels_.push_back(std::move(level));
  }
}

Vec4 MaterialTexture::look(int level, glm::dvec2 at) const {
  const int x = wrapped(at.x, width_, wrap_u_), y = wrapped(at.y, height_, wrap_v_);
  Pixel found;
  if (level == 0) {
    found = pixel(x, y);
  } else {
    std::call_once(made_, [this] { makeLevels(); });
    if (levels_.empty()) return look(0, at);  // one pixel
    level = std::min(level, static_cast<int>(levels_.size()));
    const Level& l = levels_[static_cast<std::size_t>(level - 1)];
    found = l.pixels[static_cast<std::size_t>(y >> level) * static_cast<std::size_t>(l.width) +
                     static_cast<std::size_t>(x >> level)];
  }
  return Vec4(found[0], found[1], found[2], found[3]) * (1.0f / 65535.0f);
}

MaterialTextures::MaterialTextures(const scene::Scene& scene)
    : scene_(scene), by_material_(scene.materials.size()) {
  for (const scene::Mesh& mesh : scene.meshes) {
    auto& texture = by_material_[mesh.material];
    const scene::Material& material = scene.materials[mesh.material];
    if (!texture && MaterialTexture::possible(scene, mesh, material))
      texture = std::make_unique<MaterialTexture>(scene, material);
  }
}

const MaterialTexture* MaterialTextures::of(const scene::Mesh& mesh) const {
  return MaterialTexture::possible(scene_, mesh, scene_.materials[mesh.material])
             ? by_material_[mesh.material].get()
             : nullptr;
}

}  // namespace relume::atlas
