// SPDX-License-Identifier: MIT
// Where the rays of a packet end.
#pragma once
#include <cstdint>

#include "lightmap/exposure.h"
#include "lightmap/texel_lookup.h"
#include "relume/trace/tracer.h"

namespace relume::transport {

/// One side of a texel, as a number: the index of its point, and a bit for the back.
using SideOfTexel = std::uint32_t;
inline constexpr SideOfTexel kBackBit = 0x80000000u, kNoTexel = 0xffffffffu;

/// Where a ray ends that hit something. Without `exposure` every texel answers for all of its footprint.
inline SideOfTexel endOf(const scene::Hit& hit, bool behind, Point origin, Point end,
                         const TexelLookup& lookup, const Exposure* exposure) {
  const std::uint32_t point = lookup.point(hit);
  if (point == scene::kNone) return kNoTexel;
  if (behind) return point | kBackBit;
  return exposure ? exposure->answering(point, origin, end) : point;
}

/// The same for the ray of a lane.
inline SideOfTexel endOf(const trace::RayPacket& rays, const trace::HitPacket& hits, std::uint32_t lane,
                         const TexelLookup& lookup, const Exposure* exposure) {
  const Point origin(rays.origin_x[lane], rays.origin_y[lane], rays.origin_z[lane]);
  const Direction d(rays.direction_x[lane], rays.direction_y[lane], rays.direction_z[lane]);
  return endOf(hits.where(lane), ((hits.behind >> lane) & 1u) != 0, origin, origin + hits.t[lane] * d, lookup,
               exposure);
}

}  // namespace relume::transport
