// SPDX-License-Identifier: MIT
// What the rays of a packet bring from where they end.
#pragma once
#include <array>
#include <vector>

#include "lightmap/radiance_cache.h"
#include "lightmap/side_of_texel.h"
#include "relume/core/quantity.h"

namespace relume::transport {

/// Light as (red, green, blue, luminance), by lane of a packet or by texel of a group.
using LightLanes = std::array<Vec4, trace::RayPacket::kSize>;
inline Vec4 withLuminance(Vec3 rgb) { return {rgb, luminance(rgb)}; }

/// The radiance cache once more, by texel of the atlas instead of by point, which spares every ray a look-up.
class EndRadiance {
 public:
  /// Keeps references.
  EndRadiance(const TexelLookup& lookup, const Exposure& exposure, const RadianceCache& cache);

  /// Radiance by lane; black where a ray ends nowhere. Returns lanes whose ends send glossy light too, which
  /// is to be followed: bit i for lane i, by chance.
  std::uint32_t of(const trace::RayPacket& rays, const trace::HitPacket& hits, LightLanes& radiance) const;
  /// One over that chance.
  float perWalk(const scene::Hit& hit) const {
    return 256.0f / static_cast<float>(cache_.walkChance(lookup_.point(hit)));
  }

 private:
  const TexelLookup& lookup_;
  const Exposure& exposure_;
  const RadianceCache& cache_;
  /// By texel, that for none too. A luminance below 0: it depends on more than the texel.
  std::vector<Vec4> texels_;
  std::vector<std::uint8_t> walk_chance_;  ///< by texel, that for none too; or empty
};

}  // namespace relume::transport
