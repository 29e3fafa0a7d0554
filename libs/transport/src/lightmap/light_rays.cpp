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

bool LightRays::add(const GroupRays& rays, Reach reach, std::uint32_t texel, std::uint32_t sample,
                    std::uint32_t row) {
  const std::size_t at = std::size_t{sample} * LightTable::kColumns + rays.columnOf(texel);
  const Vec2 shift = rays.shift();
  const GroupRays::Spot spot = rays.spot(texel, {table_.u[at], table_.v[at]});
  const LightSample light =
      emitters_.sample(reach, spot.origin, spot.geometric_normal,
                       {shifted(table_.place_x[at], shift.x), shifted(table_.place_y[at], shift.y)},
                       shifted(table_.choice[at], 0.5f * (shift.x + shift.y)));
  if (!(light.pdf > 0) || !RayFrame::above(light.direction, spot.geometric_normal)) return false;
  const float cosine = glm::dot(light.direction, spot.shading_normal);
  if (!(cosine > 0)) return false;
  Vec3 value = light.value * (cosine / light.pdf);
  if (!alone_ && !light.delta) value *= powerHeuristic(light.pdf, cosine * kInvPi);
  Direction direction = light.direction;
  float t_max = kInfinity;
  if (!light.endless) {
    const Vec3 way = light.end - spot.origin;
    const float distance = glm::length(way);
    if (distance > 0) direction = way / distance, t_max = distance * kShortOfLight;
  }
  const std::uint32_t lane = filled_++;
  packet_.origin_x[lane] = spot.origin.x, packet_.origin_y[lane] = spot.origin.y,
  packet_.origin_z[lane] = spot.origin.z;
  packet_.direction_x[lane] = direction.x, packet_.direction_y[lane] = direction.y,
  packet_.direction_z[lane] = direction.z;
  packet_.t_max[lane] = t_max;
  packet_.alpha_seed[lane] = rays.alphaStream(texel) + kAlphaSeeds + sample;
  waiting_[lane] = {texel, row, value, cosine, light.direction};
  return true;
}

std::uint32_t LightRays::blocked() {
  for (std::uint32_t lane = filled_; lane < trace::RayPacket::kSize; ++lane) {
    packet_.origin_x[lane] = packet_.origin_y[lane] = packet_.origin_z[lane] = 0.0f;
    packet_.direction_x[lane] = packet_.direction_y[lane] = 0.0f, packet_.direction_z[lane] = 1.0f;
    packet_.t_max[lane] = -1.0f, packet_.alpha_seed[lane] = 0;
  }
  return tracer_.occludedPacket(packet_);
}

}  // namespace relume::transport
