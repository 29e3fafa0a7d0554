// SPDX-License-Identifier: MIT
#include "texel_pass.h"

#include <bit>

namespace relume::render {
namespace {

constexpr std::uint32_t kGroup = 64;

struct RingTexel {
  std::uint32_t place, neighbours;  // bit 3 (dy + 1) + dx + 1: that neighbour is covered
};

std::vector<RingTexel> ringOf(const asset::AtlasTable& atlas) {
  const int width = atlas.width, height = atlas.height;
  std::vector<std::uint8_t> covered(atlas.pageTexels(), 0);
  for (const std::uint32_t t : atlas.texel) covered[t] = 1;
  std::vector<RingTexel> ring;
  for (std::size_t at = 0; at < covered.size(); ++at) {
    if (covered[at]) continue;
    const int x = static_cast<int>(at) % width, y = static_cast<int>(at) / width % height;
    std::uint32_t bits = 0;
    for (int dy = -1; dy <= 1; ++dy)
      for (int dx = -1; dx <= 1; ++dx)
        if (x + dx >= 0 && x + dx < width && y + dy >= 0 && y + dy < height &&
            covered[static_cast<std::size_t>(static_cast<std::ptrdiff_t>(at) + dy * width + dx)])
          bits |= 1u << (3 * (dy + 1) + dx + 1);
    if (bits) ring.push_back({static_cast<std::uint32_t>(at), bits});
  }
  return ring;
}

}  // namespace

TexelPass::TexelPass(const asset::AtlasTable& atlas)
    : size_(atlas.width, atlas.height),
      layers_(static_cast<int>(atlas.pages)),
      texel_(atlas.texel),
      texels_program_(Program::compute("relight_texels.comp.glsl")),
      ring_program_(Program::compute("relight_ring.comp.glsl")),
      texels_(atlas.texel),
      near_(0),
      pages_(Texture::makeArray(GL_RGBA32F, size_, layers_)) {
  pages_.plain(true);
  glClearTexImage(pages_.name(), 0, GL_RGBA, GL_FLOAT, nullptr);
  const std::vector<RingTexel> ring = ringOf(atlas);
  ring_count_ = static_cast<std::uint32_t>(ring.size());
  ring_ = Buffer(ring);
}

void TexelPass::interpolateBy(const relight::ExitInterpolation& taps, const asset::NearShares& near_share) {
  std::vector<std::uint32_t> packed;
  for (std::size_t k = 0; k < taps.exit().size(); ++k) {
    packed.push_back(taps.exit()[k]);
    packed.push_back(std::bit_cast<std::uint32_t>(taps.weight()[k]));
  }
  taps_ = Buffer(packed);
  first_ = Buffer(taps.first().size_bytes(), taps.first().data());
  std::vector<Vec4> near;
  for (const Vec3& c : near_share) near.emplace_back(c, 0.0f);
  has_near_ = !near.empty();
  near_ = Buffer(near);
}

void TexelPass::run(const Buffer& exits, const Buffer& direct, std::size_t first_direct) {
  glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
  first_.bindStorage(1);
  taps_.bindStorage(2);
  exits.bindStorage(3);
  texels_.bindStorage(4);
  near_.bindStorage(5);
  direct.bindStorage(6);
  glBindImageTexture(0, pages_.name(), 0, GL_TRUE, 0, GL_WRITE_ONLY, GL_RGBA32F);
  texels_program_.set("u_texels", static_cast<std::uint32_t>(texel_.size()));
  texels_program_.set("u_has_near", has_near_ ? 1u : 0u);
  texels_program_.set("u_first_direct", static_cast<std::uint32_t>(first_direct));
  texels_program_.dispatch(texel_.size(), kGroup);
  fillRing();
}

void TexelPass::fillRing() {
  glMemoryBarrier(GL_SHADER_IMAGE_ACCESS_BARRIER_BIT);
  ring_.bindStorage(1);
  glBindImageTexture(0, pages_.name(), 0, GL_TRUE, 0, GL_READ_WRITE, GL_RGBA32F);
  ring_program_.set("u_count", ring_count_);
  ring_program_.dispatch(ring_count_, kGroup);
  glMemoryBarrier(GL_TEXTURE_FETCH_BARRIER_BIT | GL_TEXTURE_UPDATE_BARRIER_BIT);
}

void TexelPass::write(std::span<const Irradiance> texels) {
  std::vector<Vec4> all(static_cast<std::size_t>(size_.x) * static_cast<std::size_t>(size_.y) *
                            static_cast<std::size_t>(layers_),
                        Vec4(0));
  for (std::size_t i = 0; i < texel_.size(); ++i) all[texel_[i]] = Vec4(texels[i].rgb, 1);
  glTextureSubImage3D(pages_.name(), 0, 0, 0, 0, size_.x, size_.y, layers_, GL_RGBA, GL_FLOAT, all.data());
  fillRing();
}

std::vector<Irradiance> TexelPass::read() const {
  std::vector<Vec4> all(static_cast<std::size_t>(size_.x) * static_cast<std::size_t>(size_.y) *
                        static_cast<std::size_t>(layers_));
  glGetTextureImage(pages_.name(), 0, GL_RGBA, GL_FLOAT, static_cast<GLsizei>(all.size() * sizeof(Vec4)),
                    all.data());
  std::vector<Irradiance> out;
  out.reserve(texel_.size());
  for (const std::uint32_t t : texel_) out.emplace_back(Vec3(all[t]));
  return out;
}

}  // namespace relume::render
