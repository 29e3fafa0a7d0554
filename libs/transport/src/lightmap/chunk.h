// SPDX-License-Identifier: MIT
// What the samples of a group's texels brought in one chunk: sums, and the luminances that tell the error.
#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "group_rays.h"
#include "lightmap/end_radiance.h"

namespace relume::transport {

class Chunk {
 public:
  static constexpr std::uint32_t kColumns = SampleTable::kColumns;
  static_assert(kColumns == GroupRays::kLanes);

  void begin(std::uint32_t count) {
    sum_.fill(Vec4(0.0f));
    grey_.assign(std::size_t{count} * kColumns, 0.0f);
  }

  void add(std::uint32_t texel, std::uint32_t sample, Vec3 light) {
    const Vec4 all = withLuminance(light);
    sum_[texel] += all;
    grey_[std::size_t{sample} * kColumns + texel] += all.w;
  }

  /// What the rays of a packet brought whose first sample is `sample`; black where there is no ray.
  void add(const GroupRays& rays, std::uint32_t sample, const LightLanes& light) {
    float* rows = &grey_[std::size_t{sample} * kColumns];
    if (rays.everyLaneInItsSlot()) {
      for (std::uint32_t i = 0; i < kColumns; ++i) sum_[i] += light[i], rows[i] = light[i].w;
      return;
    }
    for (std::uint32_t lane = 0; lane < kColumns; ++lane)
      if (rays.used(lane)) sum_[rays.texelOf(lane)] += light[lane], rows[rays.slotOf(lane)] = light[lane].w;
  }

  Vec3 sum(std::size_t texel) const { return Vec3(sum_[texel]); }
  /// Sum of luminances.
  float greySum(std::size_t texel) const { return sum_[texel].w; }
  /// Luminances, [count][16], a net in Morton order.
  std::span<const float> grey() const { return grey_; }

 private:
  LightLanes sum_;  // by texel
  std::vector<float> grey_;
};

}  // namespace relume::transport
