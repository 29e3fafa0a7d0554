// SPDX-License-Identifier: MIT
#include "lightmap/end_radiance.h"

#include <array>
#include <bit>

#include "relume/core/parallel.h"

namespace relume::transport {

EndRadiance::EndRadiance(const TexelLookup& lookup, const Exposure& exposure, const RadianceCache& cache)
    : lookup_(lookup), exposure_(exposure), cache_(cache), texels_(lookup.texels(), Vec4(0.0f)) {
  parallelFor(texels_.size(), std::size_t{1} << 14, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      if (const std::uint32_t point = lookup.pointOf(static_cast<std::uint32_t>(i)); point != scene::kNone)
        texels_[i] = Vec4(cache.radiance(point), exposure.parted(point) ? 1.0f : 0.0f);
  });
}

void EndRadiance::of(const trace::RayPacket& rays, const trace::HitPacket& hits,
                     LaneColours& radiance) const {
  constexpr std::uint32_t kLanes = trace::RayPacket::kSize;
  std::array<std::uint32_t, kLanes> texel;
  lookup_.texels(hits, texel);
  std::uint32_t asked = hits.behind;
  for (std::uint32_t lane = 0; lane < kLanes; ++lane) {
    const Vec4& found = texels_[texel[lane]];
    radiance.r[lane] = found.x, radiance.g[lane] = found.y, radiance.b[lane] = found.z;
    asked |= static_cast<std::uint32_t>(found.w != 0.0f) << lane;
  }
  for (; asked != 0; asked &= asked - 1) {
    const auto lane = static_cast<std::uint32_t>(std::countr_zero(asked));
    const Vec3 rgb = cache_.radiance(endOf(rays, hits, lane, lookup_, &exposure_));
    radiance.r[lane] = rgb.x, radiance.g[lane] = rgb.y, radiance.b[lane] = rgb.z;
  }
}

}  // namespace relume::transport
