// SPDX-License-Identifier: MIT
#include "lightmap/gatherer.h"

#include <algorithm>

namespace relume::transport {
namespace {

template <class Array>
Vec3 laneOf(const Array& x, const Array& y, const Array& z, std::uint32_t lane) {
  return {x[lane], y[lane], z[lane]};
}

}  // namespace

void Gatherer::add(const LightSeen& seen, Direction direction, Normal shading_normal, Arrival& result) const {
  const float own = std::max(glm::dot(direction, shading_normal), 0.0f) * kInvPi;
  result.emitted += seen.radiance.rgb * (own > 0 ? powerHeuristic(own, seen.pdf) : 0.0f);
}

void Gatherer::addSurface(const GroupRays::Normals& normals, const trace::HitPacket& hits, std::uint32_t lane,
                          Arrival& result) {
  const Vec3 d = laneOf(packet_.direction_x, packet_.direction_y, packet_.direction_z, lane);
  const Point p = laneOf(packet_.origin_x, packet_.origin_y, packet_.origin_z, lane);
  const LightSeen seen = emitters_.onSurface(p, normals.geometric, d, hits.where(lane), hits.t[lane],
                                             ((hits.back_face >> lane) & 1u) != 0);
  if (seen.radiance.rgb != Vec3(0)) add(seen, d, normals.shading, result);
}

void Gatherer::addBeside(const GroupRays::Normals& normals, float distance, std::uint32_t lane,
                         Arrival& result) {
  const Vec3 d = laneOf(packet_.direction_x, packet_.direction_y, packet_.direction_z, lane);
  const Point p = laneOf(packet_.origin_x, packet_.origin_y, packet_.origin_z, lane);
  seen_.clear();
  emitters_.onRay(p, normals.geometric, d, 0.0f, distance, seen_);
  for (const LightSeen& seen : seen_) add(seen, d, normals.shading, result);
}

}  // namespace relume::transport
