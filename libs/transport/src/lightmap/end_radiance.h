// SPDX-License-Identifier: MIT
// What the rays of a packet bring from where they end.
#pragma once
#include <array>
#include <span>
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

  /// What the cache does not tell, bit i for lane i.
  struct Open {
    std::uint32_t walks = 0;  ///< by chance: the end sends glossy light too, which is to be followed
    std::uint32_t near = 0;   ///< the ray ends nearer than the length of its last texel allows (near_walk.h)
  };
  /// Radiance by lane; black where a ray ends nowhere.
  Open of(const trace::RayPacket& rays, const trace::HitPacket& hits, LightLanes& radiance) const;
  /// From now on rays are near that end before this way, by point, in metres.
  void watchNear(std::span<const float> reach);
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
  std::vector<float> reach_;               ///< by texel, that for none too; or empty
};

}  // namespace relume::transport
