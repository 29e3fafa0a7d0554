// SPDX-License-Identifier: MIT
// From exits to the pages of the atlas, with the ring of texels about charts that bilinear look-ups read.
#pragma once
#include "gl_objects.h"
#include "relume/asset/transfer.h"
#include "relume/relight/exit_interpolation.h"

namespace relume::render {

class TexelPass {
 public:
  explicit TexelPass(const asset::AtlasTable& atlas);
  void interpolateBy(const relight::ExitInterpolation& taps, const asset::NearShares& near_share);

  /// `direct`: irradiance of texels from `first_direct` on, read where short ways are left out.
  void run(const Buffer& exits, const Buffer& direct, std::size_t first_direct);
  /// Irradiance of texels from memory instead. shape: [texels of the atlas table]
  void write(std::span<const Irradiance> texels);
  const Texture& pages() const { return pages_; }
  /// Waits for the device. shape: [texels of the atlas table]
  std::vector<Irradiance> read() const;

 private:
  void fillRing();

  IVec2 size_;
  int layers_;
  std::vector<std::uint32_t> texel_;
  std::uint32_t ring_count_ = 0;
  bool has_near_ = false;
  Program texels_program_, ring_program_;
  Buffer texels_, ring_, first_, taps_, near_;
  Texture pages_;
};

}  // namespace relume::render
