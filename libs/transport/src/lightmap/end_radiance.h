// SPDX-License-Identifier: MIT
// What the rays of a packet bring from where they end.
#pragma once
#include <vector>

#include "lightmap/radiance_cache.h"
#include "lightmap/side_of_texel.h"

namespace relume::transport {

/// A colour for each lane of a packet.
struct alignas(64) LaneColours {
  float r[trace::RayPacket::kSize], g[trace::RayPacket::kSize], b[trace::RayPacket::kSize];

  void clear() { *this = {}; }
  void add(std::uint32_t lane, Vec3 rgb) { r[lane] += rgb.x, g[lane] += rgb.y, b[lane] += rgb.z; }
};

/// The radiance cache once more, by texel of the atlas instead of by point, which spares every ray a look-up.
class EndRadiance {
 public:
  /// Keeps references.
  EndRadiance(const TexelLookup& lookup, const Exposure& exposure, const RadianceCache& cache);

  /// Radiance by lane; black where a ray ends nowhere.
  void of(const trace::RayPacket& rays, const trace::HitPacket& hits, LaneColours& radiance) const;

 private:
  const TexelLookup& lookup_;
  const Exposure& exposure_;
  const RadianceCache& cache_;
  /// By texel, that for none too: RGB; w is 1 where it depends on more than the texel.
  std::vector<Vec4> texels_;
};

}  // namespace relume::transport
