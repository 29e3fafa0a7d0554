// SPDX-License-Identifier: MIT
#include "lightmap/gatherer.h"

#include <algorithm>

namespace relume::transport {
namespace {

Point originOf(const trace::RayPacket& rays, std::uint32_t lane) {
  return {rays.origin_x[lane], rays.origin_y[lane], rays.origin_z[lane]};
}
Direction directionOf(const trace::RayPacket& rays, std::uint32_t lane) {
  return {rays.direction_x[lane], rays.direction_y[lane], rays.direction_z[lane]};
}

/// Light that a ray met, which light samples could have found too.
Vec3 weighted(const LightSeen& seen, Direction direction, Normal shading_normal) {
  const float own = std::max(glm::dot(direction, shading_normal), 0.0f) * kInvPi;
  return seen.radiance.rgb * (own > 0 ? powerHeuristic(own, seen.pdf) : 0.0f);
}

}  // namespace

void Gatherer::addSurface(const GroupRays::Normals& normals, const trace::RayPacket& packet,
                          const trace::HitPacket& hits, std::uint32_t lane, Vec3& sum) const {
  const Direction d = directionOf(packet, lane);
  const LightSeen seen = emitters_.onSurface(originOf(packet, lane), normals.geometric, d, hits.where(lane),
                                             hits.t[lane], ((hits.back_face >> lane) & 1u) != 0);
  if (seen.radiance.rgb != Vec3(0)) sum += weighted(seen, d, normals.shading);
}

void Gatherer::addBeside(const GroupRays::Normals& normals, const trace::RayPacket& packet, float distance,
                         std::uint32_t lane, Vec3& sum) {
  const Direction d = directionOf(packet, lane);
  seen_.clear();
  emitters_.onRay(originOf(packet, lane), normals.geometric, d, 0.0f, distance, seen_);
  for (const LightSeen& seen : seen_) sum += weighted(seen, d, normals.shading);
}

}  // namespace relume::transport
