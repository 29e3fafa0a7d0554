// SPDX-License-Identifier: MIT
#include "lightmap/light_rays.h"

#include <algorithm>

#include "power_heuristic.h"
#include "ray_frame.h"

namespace relume::transport {
namespace {

constexpr float kShortOfLight = 1.0f - 1e-5f;
// Apart from the seeds of the gather rays.
constexpr std::uint32_t kAlphaSeeds = 0x40000000u;

/// In [0, 1), around the end.
float shifted(float u, float by) {
  const float sum = u + by;
  return sum < 1.0f ? sum : std::min(sum - 1.0f, 0x1.fffffep-1f);
}

}  // namespace

void LightRays::trace(const GroupRays& rays, std::span<const std::uint32_t> active, std::uint32_t first,
                      std::uint32_t count, std::span<Vec3> values) {
  constexpr std::uint32_t kColumns = LightTable::kColumns;
  for (const Reach reach : {Reach::kLocal, Reach::kDistant}) {
    if (!emitters_.has(reach)) continue;
    for (std::uint32_t s = 0; s < count; ++s) {
      for (const std::uint32_t texel : active) {
        const std::size_t at = std::size_t{first + s} * kColumns + rays.columnOf(texel);
        const Vec2 shift = rays.shift(texel);
        const GroupRays::Spot spot = rays.spot(texel, {table_.u[at], table_.v[at]});
        const LightSample light =
            emitters_.sample(reach, spot.origin, spot.geometric_normal,
                             {shifted(table_.place_x[at], shift.x), shifted(table_.place_y[at], shift.y)},
                             shifted(table_.choice[at], 0.5f * (shift.x + shift.y)));
        if (!(light.pdf > 0) || !RayFrame::above(light.direction, spot.geometric_normal)) continue;
        const float cosine = glm::dot(light.direction, spot.shading_normal);
        if (!(cosine > 0)) continue;
        Vec3 value = light.value * (cosine / light.pdf);
        if (!alone_ && !light.delta) value *= powerHeuristic(light.pdf, cosine * kInvPi);
        Direction direction = light.direction;
        float t_max = kInfinity;
        if (!light.endless) {
          const Vec3 way = light.end - spot.origin;
          const float distance = glm::length(way);
          if (distance > 0) direction = way / distance, t_max = distance * kShortOfLight;
        }
        packet_.origin_x[filled_] = spot.origin.x, packet_.origin_y[filled_] = spot.origin.y,
        packet_.origin_z[filled_] = spot.origin.z;
        packet_.direction_x[filled_] = direction.x, packet_.direction_y[filled_] = direction.y,
        packet_.direction_z[filled_] = direction.z;
        packet_.t_max[filled_] = t_max;
        packet_.alpha_seed[filled_] = rays.alphaStream(texel) + kAlphaSeeds + first + s;
        waiting_[filled_] = {std::size_t{s} * kColumns + texel, value};
        if (++filled_ == trace::RayPacket::kSize) flush(values);
      }
    }
  }
  flush(values);
}

void LightRays::flush(std::span<Vec3> values) {
  if (filled_ == 0) return;
  for (std::uint32_t lane = filled_; lane < trace::RayPacket::kSize; ++lane) {
    packet_.origin_x[lane] = packet_.origin_y[lane] = packet_.origin_z[lane] = 0.0f;
    packet_.direction_x[lane] = packet_.direction_y[lane] = 0.0f, packet_.direction_z[lane] = 1.0f;
    packet_.t_max[lane] = -1.0f, packet_.alpha_seed[lane] = 0;
  }
  const std::uint32_t blocked = tracer_.occludedPacket(packet_);
  for (std::uint32_t lane = 0; lane < filled_; ++lane)
    if (((blocked >> lane) & 1u) == 0) values[waiting_[lane].at] += waiting_[lane].value;
  traced_ += filled_;
  filled_ = 0;
}

}  // namespace relume::transport
