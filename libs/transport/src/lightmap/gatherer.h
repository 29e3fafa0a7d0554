// SPDX-License-Identifier: MIT
// Cosine-weighted rays from texels, and what they find: the place where they end, and light on the way there.
#pragma once
#include <array>
#include <bit>
#include <cstdint>
#include <vector>

#include "bundle_guess.h"
#include "group_rays.h"
#include "lightmap/side_of_texel.h"
#include "power_heuristic.h"
#include "relume/trace/flush_denormals.h"
#include "relume/transport/emitters.h"

namespace relume::transport {

struct Arrival {
  SideOfTexel surface = kNoTexel;  ///< where the ray ends
  scene::Hit hit;                  ///< the same, where that is a texel
  Direction direction{0, 0, 1};    ///< of the ray
  /// Radiance straight from emitters, weighted against LightRays, which could have found them too
  /// (power_heuristic.h).
  Vec3 emitted{0.0f};
};

/// What tells that the texels of a group lie inside a body: how many of their rays met backs.
class BackCounts {
 public:
  void clear() { *this = {}; }

  void add(const GroupRays& rays, const trace::RayPacket& packet, const trace::HitPacket& hits) {
    if (rays.everyLaneInItsSlot()) {
      for (std::uint32_t i = 0; i < GroupRays::kLanes; ++i) rays_[i] += packet.t_max[i] >= 0.0f;
    } else {
      for (std::uint32_t i = 0; i < GroupRays::kLanes; ++i)
        rays_[rays.texelOf(i)] += rays.used(i) && packet.t_max[i] >= 0.0f;
    }
    for (std::uint32_t behind = hits.behind; behind != 0; behind &= behind - 1) {
      const auto lane = static_cast<std::uint32_t>(std::countr_zero(behind));
      if (!rays.used(lane)) continue;
      const std::uint32_t texel = rays.texelOf(lane);
      ++behind_[texel], backs_[texel] += (hits.back_face >> lane) & 1u;
    }
  }

  /// Of a texel's rays the share that met backs of single-sided surfaces; 1 in the dark within a closed body
  /// that is double-sided.
  float share(std::size_t texel, bool dark) const {
    if (rays_[texel] == 0) return 0.0f;
    if (dark && behind_[texel] == rays_[texel]) return 1.0f;
    return static_cast<float>(backs_[texel]) / static_cast<float>(rays_[texel]);
  }
  std::uint32_t backs(std::size_t texel) const { return backs_[texel]; }
  std::uint32_t behind(std::size_t texel) const { return behind_[texel]; }

 private:
  std::array<std::uint32_t, kGroupTexels> rays_{}, backs_{}, behind_{};
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
        beside_(emitters.seenBesideSurfaces()),
        before_(emitters.seenBeforeSurfaces()),
        guess_(tracer.scene()) {}

  /// Traces samples first .. first + count - 1 of the texels that `rays` has selected. Calls visit(sample -
  /// first, packet, hits); lanes of the packet with t_max < 0 are no rays.
  template <class Visit>
  void tracePackets(const GroupRays& rays, std::uint32_t first, std::uint32_t count, const Visit& visit) {
    trace::RayPacket packet;
    trace::HitPacket hits;
    const trace::FlushDenormals flush;
    if (first == 0) guess_.begin();
    for (std::uint32_t s = 0; s < count; s += rays.samplesPerPacket()) {
      rays.packet(first + s, packet);
      tracer_.intersectPacket(packet, hits, guess_.next());
      guess_.met(hits);
      std::uint32_t traced = 0;
      for (const float t_max : packet.t_max) traced += t_max >= 0.0f;
      traced_ += traced;
      visit(s, packet, hits);
    }
  }

  /// The same ray by ray: calls visit(texel, sample - first, arrival) for each that leaves the surface; the
  /// others bring nothing. Adds to `backs`.
  template <class Visit>
  void trace(const GroupRays& rays, std::uint32_t first, std::uint32_t count, BackCounts& backs,
             const Visit& visit) {
    tracePackets(rays, first, count,
                 [&](std::uint32_t s, const trace::RayPacket& packet, const trace::HitPacket& hits) {
                   backs.add(rays, packet, hits);
                   for (std::uint32_t lane = 0; lane < GroupRays::kLanes; ++lane)
                     if (rays.used(lane) && packet.t_max[lane] >= 0.0f)
                       visit(rays.texelOf(lane), s + rays.sampleOf(lane),
                             arrival(rays, first + s, packet, hits, lane));
                 });
  }

  /// What a lane's ray sees of emitters, weighted (Arrival::emitted), in the packet that begins with sample
  /// `first`.
  Vec3 emitted(const GroupRays& rays, std::uint32_t first, const trace::RayPacket& packet,
               const trace::HitPacket& hits, std::uint32_t lane) {
    Vec3 sum(0.0f);
    const bool hit = ((hits.hit >> lane) & 1u) != 0;
    if (hit && emitters_.emits(hits.instance[lane]))
      addSurface(rays.normals(first, lane), packet, hits, lane, sum);
    if (hit ? before_ : beside_)
      addBeside(rays.normals(first, lane), packet, hit ? hits.t[lane] : kInfinity, lane, sum);
    return sum;
  }
  /// No ray sees any.
  bool nothingSeen() const { return !beside_ && emitters_.triangleCount() == 0; }

  std::uint64_t rays() const { return traced_; }

 private:
  Arrival arrival(const GroupRays& rays, std::uint32_t first, const trace::RayPacket& packet,
                  const trace::HitPacket& hits, std::uint32_t lane) {
    Arrival result;
    result.direction = {packet.direction_x[lane], packet.direction_y[lane], packet.direction_z[lane]};
    if (((hits.hit >> lane) & 1u) != 0) {
      result.surface = endOf(packet, hits, lane, lookup_, exposure_);
      result.hit = hits.where(lane);
    }
    result.emitted = emitted(rays, first, packet, hits, lane);
    return result;
  }
  void addSurface(const GroupRays::Normals& normals, const trace::RayPacket& packet,
                  const trace::HitPacket& hits, std::uint32_t lane, Vec3& sum) const;
  void addBeside(const GroupRays::Normals& normals, const trace::RayPacket& packet, float distance,
                 std::uint32_t lane, Vec3& sum);

  const trace::Tracer& tracer_;
  const TexelLookup& lookup_;
  const Exposure* exposure_;
  const Emitters& emitters_;
  const bool beside_, before_;
  BundleGuess guess_;
  std::vector<LightSeen> seen_;
  std::uint64_t traced_ = 0;
};

}  // namespace relume::transport
