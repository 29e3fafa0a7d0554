// SPDX-License-Identifier: MIT
#include "lightmap/end_radiance.h"

#include <bit>

#include "relume/core/parallel.h"

namespace relume::transport {
namespace {

constexpr Vec4 kToBeAsked(0.0f, 0.0f, 0.0f, -1.0f);

}  // namespace

EndRadiance::EndRadiance(const TexelLookup& lookup, const Exposure& exposure, const RadianceCache& cache)
    : lookup_(lookup), exposure_(exposure), cache_(cache), texels_(lookup.texels(), Vec4(0.0f)) {
  if (cache.anyWalks()) walk_chance_.assign(lookup.texels(), 0);
  parallelFor(texels_.size(), std::size_t{1} << 14, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const std::uint32_t point = lookup.pointOf(static_cast<std::uint32_t>(i));
      if (point == scene::kNone) continue;
      texels_[i] = exposure.parted(point) ? kToBeAsked : withLuminance(cache.radiance(point));
      if (!walk_chance_.empty()) walk_chance_[i] = static_cast<std::uint8_t>(cache.walkChance(point));
    }
  });
}

void EndRadiance::watchNear(std::span<const float> reach) {
  reach_.assign(lookup_.texels(), -1.0f);
  for (std::uint32_t i = 0; i < reach_.size(); ++i) {
    const std::uint32_t point = lookup_.pointOf(i);
    // What glossy lobes send from there is followed anyhow, and by chance.
    if (point != scene::kNone && cache_.walkChance(point) == 0) reach_[i] = reach[point];
  }
}

EndRadiance::Open EndRadiance::of(const trace::RayPacket& rays, const trace::HitPacket& hits,
                                  LightLanes& radiance) const {
  constexpr std::uint32_t kLanes = trace::RayPacket::kSize;
  LaneTexels texel;
  lookup_.texels(hits, texel);
  for (std::uint32_t lane = 0; lane < kLanes; ++lane) radiance[lane] = texels_[texel[lane]];
  std::uint32_t asked = hits.behind;
  for (std::uint32_t lane = 0; lane < kLanes; ++lane)
    asked |= static_cast<std::uint32_t>(radiance[lane].w < 0.0f) << lane;
  for (; asked != 0; asked &= asked - 1) {
    const auto lane = static_cast<std::uint32_t>(std::countr_zero(asked));
    radiance[lane] = withLuminance(cache_.radiance(endOf(rays, hits, lane, lookup_, &exposure_)));
  }
  Open open;
  if (!reach_.empty())
    for (std::uint32_t lane = 0; lane < kLanes; ++lane)
      open.near |= static_cast<std::uint32_t>(hits.t[lane] < reach_[texel[lane]]) << lane;
  open.near &= hits.hit;
  if (walk_chance_.empty()) return open;
  // The golden ratio spreads the chances of a texel's samples, whose seeds are consecutive.
  for (std::uint32_t lane = 0; lane < kLanes; ++lane)
    open.walks |=
        static_cast<std::uint32_t>((rays.alpha_seed[lane] * 0x9e3779b1u) >> 24 < walk_chance_[texel[lane]])
        << lane;
  return open;
}

}  // namespace relume::transport
