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

  /// Samples first .. first + count - 1 of the `active` texels of the group in `rays`: adds the irradiance
  /// that sample s of texel t stands for to values[s - first][t]. values: [count][16].
  void trace(const GroupRays& rays, std::span<const std::uint32_t> active, std::uint32_t first,
             std::uint32_t count, std::span<Vec3> values);

  std::uint64_t rays() const { return traced_; }

 private:
  void flush(std::span<Vec3> values);

  const trace::Tracer& tracer_;
  const Emitters& emitters_;
  const LightTable& table_;
  const bool alone_;
  trace::RayPacket packet_;
  std::uint32_t filled_ = 0;
  struct Waiting {
    std::size_t at;
    Vec3 value;
  };
  std::array<Waiting, trace::RayPacket::kSize> waiting_;
  std::uint64_t traced_ = 0;
};

}  // namespace relume::transport
