// SPDX-License-Identifier: MIT
// Rays from sides of texels, and the sides of texels where they end.
#pragma once
#include <cstdint>
#include <numeric>
#include <span>
#include <vector>

#include "group_rays.h"
#include "lightmap/gatherer.h"

namespace relume::transport {

/// What all rays need. References are kept by who traces.
struct SurfaceScene {
  const trace::Tracer& tracer;
  const atlas::Texels& texels;
  const TexelLookup& lookup;
  const Exposure& exposure;
};

class SideRays {
 public:
  SideRays(const SurfaceScene& scene, const SampleTable& samples, std::uint64_t seed, Alignment alignment)
      : scene_(scene),
        rays_(scene.tracer.scene(), scene.texels, samples, seed, kInfinity, alignment, &scene.exposure) {}

  struct End {
    SideOfTexel surface = kNoTexel;  ///< kNoTexel: none, or one that has no texel
    bool back = false;               ///< of a single-sided surface: no eye ought to see it
    float distance = kInfinity;      ///< metres
  };

  /// Cosine-weighted rays 0 .. count - 1 of each texel of a group. Calls visit(place in the group, end) for
  /// each that leaves the surface; the others bring nothing.
  template <class Visit>
  void trace(std::span<const std::uint32_t> group, Side side, std::uint32_t count, const Visit& visit) {
    rays_.begin(group, side);
    all_.resize(group.size());
    std::iota(all_.begin(), all_.end(), 0u);
    rays_.select(all_, count);
    for (std::uint32_t s = 0; s < count; s += rays_.samplesPerPacket()) {
      rays_.packet(s, packet_);
      scene_.tracer.intersectPacket(packet_, hits_);
      for (std::uint32_t lane = 0; lane < GroupRays::kLanes; ++lane)
        if (rays_.used(lane) && packet_.t_max[lane] >= 0.0f)
          ++traced_, visit(rays_.texelOf(lane), rays_.sampleOf(lane) + s, end(lane));
    }
  }
  std::uint64_t rays() const { return traced_; }

 private:
  End end(std::uint32_t lane) const {
    End result;
    if (((hits_.hit >> lane) & 1u) == 0) return result;
    const bool behind = ((hits_.behind >> lane) & 1u) != 0;
    result.back = ((hits_.back_face >> lane) & 1u) != 0;
    result.distance = hits_.t[lane];
    std::uint32_t point = scene_.lookup.point(hits_.where(lane));
    if (point == scene::kNone) return result;
    if (!behind) {
      const Point origin(packet_.origin_x[lane], packet_.origin_y[lane], packet_.origin_z[lane]);
      const Direction d(packet_.direction_x[lane], packet_.direction_y[lane], packet_.direction_z[lane]);
      point = scene_.exposure.answering(point, origin, origin + hits_.t[lane] * d);
    }
    result.surface = point | (behind ? kBackBit : 0u);
    return result;
  }

  const SurfaceScene& scene_;
  GroupRays rays_;
  trace::RayPacket packet_;
  trace::HitPacket hits_;
  std::vector<std::uint32_t> all_;
  std::uint64_t traced_ = 0;
};

}  // namespace relume::transport
