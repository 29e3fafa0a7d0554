// SPDX-License-Identifier: MIT
// Direct light at texels, by sampling emitters.
#pragma once
#include <array>
#include <cstdint>
#include <span>

#include "group_rays.h"
#include "lightmap/light_table.h"
#include "relume/transport/emitters.h"

namespace relume::transport {

class LightRays {
 public:
  /// Keeps references. `alone`: nothing else finds light; otherwise what Gatherer could have found too is
  /// weighted (power_heuristic.h), and both are to be added.
  LightRays(const trace::Tracer& tracer, const Emitters& emitters, const LightTable& table, bool alone)
      : tracer_(tracer), emitters_(emitters), table_(table), alone_(alone) {}

  /// Samples first .. first + count - 1 of the `active` texels of the group in `rays`. Calls visit(texel,
  /// sample - first, irradiance, cosine of its angle, direction) for what arrives; a sample may be visited
  /// twice.
  template <class Visit>
  void trace(const GroupRays& rays, std::span<const std::uint32_t> active, std::uint32_t first,
             std::uint32_t count, const Visit& visit) {
    for (const Reach reach : {Reach::kLocal, Reach::kDistant}) {
      if (!emitters_.has(reach)) continue;
      for (std::uint32_t s = 0; s < count; ++s)
        for (const std::uint32_t texel : active)
          if (add(rays, reach, texel, first + s, s) && filled_ == trace::RayPacket::kSize) flush(visit);
    }
    flush(visit);
  }

  std::uint64_t rays() const { return traced_; }

 private:
  /// Whether the sample needs a ray, which then waits in the packet.
  bool add(const GroupRays& rays, Reach reach, std::uint32_t texel, std::uint32_t sample, std::uint32_t row);
  /// Bit i: what waits in lane i is blocked.
  std::uint32_t blocked();
  template <class Visit>
  void flush(const Visit& visit) {
    if (filled_ == 0) return;
    const std::uint32_t hidden = blocked();
    for (std::uint32_t lane = 0; lane < filled_; ++lane) {
      const Waiting& w = waiting_[lane];
      if (((hidden >> lane) & 1u) == 0) visit(w.texel, w.row, w.value, w.cosine, w.direction);
    }
    traced_ += filled_;
    filled_ = 0;
  }

  const trace::Tracer& tracer_;
  const Emitters& emitters_;
  const LightTable& table_;
  const bool alone_;
  trace::RayPacket packet_;
  std::uint32_t filled_ = 0;
  struct Waiting {
    std::uint32_t texel, row;
    Vec3 value;
    float cosine;
    Direction direction;
  };
  std::array<Waiting, trace::RayPacket::kSize> waiting_;
  std::uint64_t traced_ = 0;
};

}  // namespace relume::transport
