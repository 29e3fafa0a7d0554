// SPDX-License-Identifier: MIT
// Cosine-weighted rays from texels, and what they find: the place where they end, and light on the way there.
#pragma once
#include <cstdint>
#include <vector>

#include "group_rays.h"
#include "lightmap/texel_lookup.h"
#include "power_heuristic.h"
#include "relume/transport/emitters.h"

namespace relume::transport {

/// One side of a texel, as a number: the index of its point, and a bit for the back.
using SideOfTexel = std::uint32_t;
inline constexpr SideOfTexel kBackBit = 0x80000000u, kNoTexel = 0xffffffffu;

struct Arrival {
  SideOfTexel surface = kNoTexel;  ///< where the ray ends
  /// Radiance straight from emitters, weighted against LightRays, which could have found them too
  /// (power_heuristic.h).
  Vec3 emitted{0.0f};
};

class Gatherer {
 public:
  Gatherer(const trace::Tracer& tracer, const TexelLookup& lookup, const Emitters& emitters)
      : tracer_(tracer), lookup_(lookup), emitters_(emitters), beside_(emitters.seenBesideSurfaces()) {}

  /// Traces samples first .. first + count - 1 of the texels that `rays` has selected. Calls visit(texel,
  /// sample - first, arrival) for each ray that leaves the surface; the others bring nothing.
  template <class Visit>
  void trace(const GroupRays& rays, std::uint32_t first, std::uint32_t count, const Visit& visit) {
    trace::HitPacket hits;
    for (std::uint32_t s = 0; s < count; s += rays.samplesPerPacket()) {
      rays.packet(first + s, packet_);
      tracer_.intersectPacket(packet_, hits);
      for (std::uint32_t lane = 0; lane < GroupRays::kLanes; ++lane) {
        if (!rays.used(lane) || packet_.t_max[lane] < 0.0f) continue;
        ++traced_;
        visit(rays.texelOf(lane), s + rays.sampleOf(lane), arrival(rays, first + s, hits, lane));
      }
    }
  }

  std::uint64_t rays() const { return traced_; }

 private:
  Arrival arrival(const GroupRays& rays, std::uint32_t first, const trace::HitPacket& hits,
                  std::uint32_t lane) {
    Arrival result;
    const bool hit = ((hits.hit >> lane) & 1u) != 0;
    if (hit) {
      const std::uint32_t point = lookup_.point(hits.where(lane));
      if (point != scene::kNone) result.surface = point | (((hits.behind >> lane) & 1u) != 0 ? kBackBit : 0u);
      if (emitters_.emits(hits.instance[lane])) addSurface(rays.normals(first, lane), hits, lane, result);
    }
    if (beside_) addBeside(rays.normals(first, lane), hit ? hits.t[lane] : kInfinity, lane, result);
    return result;
  }
  void addSurface(const GroupRays::Normals& normals, const trace::HitPacket& hits, std::uint32_t lane,
                  Arrival& result);
  void addBeside(const GroupRays::Normals& normals, float distance, std::uint32_t lane, Arrival& result);
  void add(const LightSeen& seen, Direction direction, Normal shading_normal, Arrival& result) const;

  const trace::Tracer& tracer_;
  const TexelLookup& lookup_;
  const Emitters& emitters_;
  const bool beside_;
  trace::RayPacket packet_;
  std::vector<LightSeen> seen_;
  std::uint64_t traced_ = 0;
};

}  // namespace relume::transport
