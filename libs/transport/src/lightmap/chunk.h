// SPDX-License-Identifier: MIT
// What the samples of a group's texels brought in one chunk: sums of colours, and what tells the error.
#pragma once
#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "group_rays.h"
#include "lightmap/end_radiance.h"
#include "relume/core/quantity.h"

namespace relume::transport {

class Chunk {
 public:
  static constexpr std::uint32_t kColumns = SampleTable::kColumns;
  static_assert(kColumns == GroupRays::kLanes);

  void begin(std::uint32_t count) {
    sum_.clear();
    grey_.assign(std::size_t{count} * kColumns, 0.0f);
  }

  void add(std::uint32_t texel, std::uint32_t sample, Vec3 irradiance) {
    sum_.add(texel, irradiance);
    grey_[std::size_t{sample} * kColumns + texel] += luminance(irradiance);
  }

  /// Irradiance by the rays of a packet whose first sample is `sample`; black where there is no ray.
  void add(const GroupRays& rays, std::uint32_t sample, const LaneColours& irradiance) {
    alignas(64) std::array<float, kColumns> grey;
    for (std::uint32_t i = 0; i < kColumns; ++i)
      grey[i] = luminance({irradiance.r[i], irradiance.g[i], irradiance.b[i]});
    float* rows = &grey_[std::size_t{sample} * kColumns];
    if (rays.everyLaneInItsSlot()) {
      for (std::uint32_t i = 0; i < kColumns; ++i) {
        sum_.r[i] += irradiance.r[i], sum_.g[i] += irradiance.g[i], sum_.b[i] += irradiance.b[i];
        rows[i] = grey[i];
      }
      return;
    }
    for (std::uint32_t lane = 0; lane < kColumns; ++lane) {
      if (!rays.used(lane)) continue;
      sum_.add(rays.texelOf(lane), {irradiance.r[lane], irradiance.g[lane], irradiance.b[lane]});
      rows[rays.slotOf(lane)] = grey[lane];
    }
  }

  Vec3 sum(std::size_t texel) const { return {sum_.r[texel], sum_.g[texel], sum_.b[texel]}; }
  /// Luminances, [count][16], a net in Morton order.
  std::span<const float> grey() const { return grey_; }

 private:
  LaneColours sum_;
  std::vector<float> grey_;
};

}  // namespace relume::transport
