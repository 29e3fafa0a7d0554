// SPDX-License-Identifier: MIT
// Cosine-weighted rays from texels, and what they find: the place where they end, and light on the way there.
#pragma once
#include <cstdint>
#include <vector>

#include "group_rays.h"
#include "lightmap/exposure.h"
#include "lightmap/texel_lookup.h"
#include "power_heuristic.h"
#include "relume/transport/emitters.h"

namespace relume::transport {

/// One side of a texel, as a number: the index of its point, and a bit for the back.
using SideOfTexel = std::uint32_t;
inline constexpr SideOfTexel kBackBit = 0x80000000u, kNoTexel = 0xffffffffu;

struct Arrival {
  SideOfTexel surface = kNoTexel;  ///< where the ray ends
  bool back = false;               ///< that is the back of a single-sided surface: no eye ought to see it
  /// Radiance straight from emitters, weighted against LightRays, which could have found them too
  /// (power_heuristic.h).
  Vec3 emitted{0.0f};
  /// The surface was met on the side its normal points away from; it may be meant to be seen from there.
  bool behind() const { return surface != kNoTexel && (surface & kBackBit) != 0; }
};

/// What tells that a texel lies inside a body: how many of its rays met backs.
struct BackCount {
  std::uint32_t rays = 0, backs = 0, behind = 0;
  void add(const Arrival& arrival) { ++rays, backs += arrival.back, behind += arrival.behind(); }
  /// Share of backs of single-sided surfaces; 1 in the dark within a closed body that is double-sided.
  float share(bool dark) const {
    if (rays == 0) return 0.0f;
    if (dark && behind == rays) return 1.0f;
    return static_cast<float>(backs) / static_cast<float>(rays);
  }
};

class Gatherer {
 public:
  /// Keeps references. Without `exposure` every texel answers for all of its footprint.
  Gatherer(const trace::Tracer& tracer, const TexelLookup& lookup, const Emitters& emitters,
           const Exposure* exposure = nullptr)
      : tracer_(tracer),
        lookup_(lookup),
        exposure_(exposure),
        emitters_(emitters),
        beside_(emitters.seenBesideSurfaces()) {}

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
      const bool behind = ((hits.behind >> lane) & 1u) != 0;
      std::uint32_t point = lookup_.point(hits.where(lane));
      if (exposure_ && point != scene::kNone && !behind)
        point = exposure_->answering(point, origin(lane), end(hits.t[lane], lane));
      if (point != scene::kNone) result.surface = point | (behind ? kBackBit : 0u);
      result.back = ((hits.back_face >> lane) & 1u) != 0;
      if (emitters_.emits(hits.instance[lane])) addSurface(rays.normals(first, lane), hits, lane, result);
    }
    if (beside_) addBeside(rays.normals(first, lane), hit ? hits.t[lane] : kInfinity, lane, result);
    return result;
  }
  Point origin(std::uint32_t lane) const {
    return {packet_.origin_x[lane], packet_.origin_y[lane], packet_.origin_z[lane]};
  }
  Point end(float t, std::uint32_t lane) const {
    return origin(lane) +
           t * Vec3(packet_.direction_x[lane], packet_.direction_y[lane], packet_.direction_z[lane]);
  }
  void addSurface(const GroupRays::Normals& normals, const trace::HitPacket& hits, std::uint32_t lane,
                  Arrival& result);
  void addBeside(const GroupRays::Normals& normals, float distance, std::uint32_t lane, Arrival& result);
  void add(const LightSeen& seen, Direction direction, Normal shading_normal, Arrival& result) const;

  const trace::Tracer& tracer_;
  const TexelLookup& lookup_;
  const Exposure* exposure_;
  const Emitters& emitters_;
  const bool beside_;
  trace::RayPacket packet_;
  std::vector<LightSeen> seen_;
  std::uint64_t traced_ = 0;
};

}  // namespace relume::transport
