// SPDX-License-Identifier: MIT
#include "light_paths/places.h"

#include <algorithm>
#include <cmath>

#include "light_paths/strata.h"
#include "light_paths/typical_light.h"
#include "morton.h"
#include "relume/core/frame.h"
#include "relume/core/parallel.h"
#include "relume/core/quantity.h"
#include "relume/core/sampling.h"

namespace relume::transport {
namespace {

/// Members along a Z-shaped curve in the plane of the group.
std::vector<std::uint32_t> alongCurve(const atlas::Texels& texels, const Sides& sides,
                                      std::span<const std::uint32_t> members) {
  Vec3 normal(0.0f);
  for (const std::uint32_t side : members) normal += sides.area(side) * sides.geometricNormal(side);
  const float length = glm::length(normal);
  const Frame frame = Frame::about(length > 0 ? normal / length : sides.geometricNormal(members[0]));
  const auto flat = [&](std::uint32_t side) {
    const Point p = texels.points[sides.point(side)].position;
    return Vec2(glm::dot(p, frame.t), glm::dot(p, frame.b));
  };
  Vec2 lo(kInfinity), hi(-kInfinity);
  for (const std::uint32_t side : members) lo = glm::min(lo, flat(side)), hi = glm::max(hi, flat(side));
  const float scale = 255.9f / std::max({hi.x - lo.x, hi.y - lo.y, 1e-20f});
  std::vector<std::pair<std::uint32_t, std::uint32_t>> keyed;
  keyed.reserve(members.size());
  for (const std::uint32_t side : members) {
    const Vec2 at = (flat(side) - lo) * scale;
    keyed.emplace_back(
        spreadBits(static_cast<std::uint32_t>(at.x)) | (spreadBits(static_cast<std::uint32_t>(at.y)) << 1),
        side);
  }
  std::sort(keyed.begin(), keyed.end());
  std::vector<std::uint32_t> order;
  order.reserve(members.size());
  for (const auto& k : keyed) order.push_back(k.second);
  return order;
}

Point positionOn(const SurfaceScene& scene, const Sides& sides, std::uint32_t side, Vec2 u) {
  const std::uint32_t point = sides.point(side);
  return sides.isBack(side) ? footprintPosition(scene.texels, scene.texels.points[point], u)
                            : scene.exposure.position(point, u);
}

}  // namespace

std::vector<float> reflectedShares(const Sides& sides, const Pieces& pieces,
                                   const MeanReflectance& reflectance) {
  const std::vector<float> area = areasOf(sides, pieces);
  std::vector<float> weight(sides.size(), 0.0f);
  for (std::size_t side = 0; side < sides.size(); ++side) {
    const std::uint32_t piece = pieces.of_side[side];
    if (piece == scene::kNone || !(area[piece] > 0)) continue;
    const float share = sides.area(side) / area[piece];
    weight[side] = share * pieces.all[piece].area * luminance(reflectance.value[sides.point(side)]);
  }
  return weight;
}

std::vector<Place> placesOn(const SurfaceScene& scene, const Sides& sides, std::span<const float> weight,
                            const Members& groups, std::uint32_t each, std::uint64_t seed) {
  const std::size_t count = groups.first.size() - 1;
  std::vector<Place> places(count * each);
  parallelFor(count, 16, [&](std::size_t begin, std::size_t end) {
    for (std::size_t g = begin; g < end; ++g) {
      const std::vector<std::uint32_t> order = alongCurve(scene.texels, sides, groups.of(g));
      forEachStratum(order, weight, each, streamOf(seed, static_cast<std::uint32_t>(g), 0),
                     [&](std::uint32_t k, std::uint32_t side, Vec2 u) {
                       places[g * each + k] = {positionOn(scene, sides, side, u), sides.shadingNormal(side),
                                               sides.geometricNormal(side)};
                     });
    }
  });
  return places;
}

Irradiance lightAt(const trace::Tracer& tracer, const Place& place, const Light& light,
                   std::uint32_t stream) {
  const Irradiance e = directIrradiance(light, place.position, place.shading_normal);
  if (e.rgb == Vec3(0.0f)) return e;
  const Point start = trace::offsetOrigin(place.position, place.geometric_normal);
  const Direction way = directionTo(light, start);
  if (glm::dot(way, place.geometric_normal) <= 0 ||
      tracer.occluded({start, way, distanceTo(light, start)}, stream))
    return Irradiance(0.0f);
  return e;
}

}  // namespace relume::transport
