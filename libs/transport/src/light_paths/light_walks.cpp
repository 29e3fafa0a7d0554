// SPDX-License-Identifier: MIT
#include "light_paths/light_walks.h"

#include <algorithm>
#include <cmath>

#include "light_paths/strata.h"
#include "relume/core/frame.h"
#include "relume/core/parallel.h"
#include "relume/core/quantity.h"
#include "relume/core/sampling.h"

namespace relume::transport {
namespace {

constexpr float kMostSurvival = 0.98f;  // so that walks end in a white furnace too
constexpr float kShortOfLight = 0.9999f;
constexpr std::uint32_t kWalkDimensions = 0x77616c6bu;

/// The rest of one walk, appended to `lights`.
void follow(const WalkScene& scene, VirtualLight at, std::uint32_t item, std::uint64_t seed,
            std::vector<VirtualLight>& lights) {
  const trace::Tracer& tracer = scene.surface.tracer;
  for (std::uint32_t step = 0;; ++step) {
    const std::uint32_t stream = streamOf(seed, item, kWalkDimensions + 2 * step);
    const Direction d = Frame::about(at.normal).toWorld(squareToCosineHemisphere(sobol2(0, stream)));
    const trace::Ray ray{trace::offsetOrigin(at.position, at.normal), d, kInfinity};
    const trace::RayHit hit = tracer.intersect(ray, hashCombine(item, step));
    if (!hit) return;
    const std::uint32_t side = sideWhere(scene.surface, scene.sides, ray, hit);
    if (side == scene::kNone) return;
    const Vec3 rho = scene.reflectance.value[scene.sides.point(side)];
    const float survival = std::min(std::max({rho.x, rho.y, rho.z}), kMostSurvival);
    if (!(sobol2(0, streamOf(seed, item, kWalkDimensions + 2 * step + 1)).x < survival)) return;
    at.power *= rho / survival;
    at.position = scene::worldPosition(tracer.scene(), hit.where);
    at.normal = scene::geometricNormal(tracer.scene(), hit.where.instance, hit.where.triangle);
    if (glm::dot(at.normal, d) > 0) at.normal = -at.normal;
    lights.push_back(at);
  }
}

/// A place on an exit: texels by their area, and of a texel what can be seen.
struct ExitPlace {
  Point position{0};
  Normal shading{0, 0, 1}, geometric{0, 0, 1};
};
ExitPlace placeOn(const SurfaceScene& scene, const Patches& exits, std::size_t exit, Vec2 u, float share) {
  const auto members = exits.membersOf(exit);
  double left = static_cast<double>(share) * static_cast<double>(exits.all[exit].area);
  std::size_t k = 0;
  while (k + 1 < members.size() && left >= static_cast<double>(scene.texels.points[members[k]].area))
    left -= static_cast<double>(scene.texels.points[members[k++]].area);
  const atlas::SurfacePoint& point = scene.texels.points[members[k]];
  return {scene.exposure.position(members[k], u), point.shading_normal, point.geometric_normal};
}

}  // namespace

std::vector<WalkStart> startsOnPatches(const SurfaceScene& scene, const Sides& sides, const PatchLight& light,
                                       const Members& patches, std::uint32_t walks, std::uint64_t seed) {
  std::vector<WalkStart> starts;
  std::vector<float> lit(sides.size(), 0.0f), size(sides.size(), 0.0f);  // by side, m^2
  for (std::uint32_t p = 0; p + 1 < patches.first.size(); ++p)
    for (std::uint32_t entry = light.first[p]; entry < light.first[p + 1]; ++entry) {
      double all = 0;
      for (const std::uint32_t side : patches.of(p)) {
        lit[side] = 0;
        for (const EntryShare& s : light.on_pieces.of(light.pieces.of_side[side]))
          if (s.entry == entry) lit[side] = s.value * sides.area(side);
        size[side] = std::abs(lit[side]), all += static_cast<double>(size[side]);
      }
      if (!(all > 0)) continue;
      forEachStratum(
          patches.of(p), size, walks, streamOf(seed, entry, kWalkDimensions),
          [&](std::uint32_t, std::uint32_t side, Vec2 u) {
            const auto area = static_cast<float>(all / walks);
            starts.push_back({entry, side,
                              footprintPosition(scene.texels, scene.texels.points[sides.point(side)], u),
                              sides.geometricNormal(side), lit[side] < 0 ? -area : area, 1});
          });
    }
  return starts;
}

std::uint32_t sideWhere(const SurfaceScene& scene, const Sides& sides, const trace::Ray& ray,
                        const trace::RayHit& hit) {
  const std::uint32_t point = scene.lookup.point(hit.where);
  if (point == scene::kNone) return scene::kNone;
  const Normal front = scene::geometricNormal(scene.tracer.scene(), hit.where.instance, hit.where.triangle);
  if (glm::dot(front, ray.direction) > 0) return sides.answering(point | kBackBit);
  return sides.answering(scene.exposure.answering(point, ray.origin, ray.origin + hit.t * ray.direction));
}

std::vector<VirtualLight> walk(const WalkScene& scene, std::span<const WalkStart> starts, std::uint64_t seed,
                               Progress& progress) {
  std::vector<std::vector<VirtualLight>> of_start(starts.size());
  const Stage stage(progress, "walks", starts.size());
  parallelFor(
      starts.size(), 16,
      [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
          const WalkStart& s = starts[i];
          const std::uint32_t point = scene.sides.point(s.side);
          VirtualLight first{s.entry, s.position, s.normal,
                             scene.reflectance.value[point] * scene.reflectance.direct[point] * s.area};
          of_start[i].push_back(first);
          first.power /= static_cast<float>(s.walks);
          for (std::uint32_t w = 0; w < s.walks; ++w)
            follow(scene, first, hashCombine(static_cast<std::uint32_t>(i), w), seed, of_start[i]);
        }
      },
      &progress);
  std::vector<VirtualLight> all;
  for (const auto& lights : of_start) all.insert(all.end(), lights.begin(), lights.end());
  return all;
}

void connect(const SurfaceScene& scene, std::span<const VirtualLight> lights, const Patches& exits,
             std::size_t exit, float near, std::uint64_t seed, std::size_t entries, std::span<float> row) {
  const std::uint32_t stream = streamOf(seed, static_cast<std::uint32_t>(exit), 0x636f6e6eu);
  for (std::uint32_t i = 0; i < lights.size(); ++i) {
    const VirtualLight& light = lights[i];
    const ExitPlace place =
        placeOn(scene, exits, exit, sobol2(i, stream), sobol2(i, hashCombine(stream, 1)).x);
    const Vec3 way = light.position - place.position;
    const float squared = glm::dot(way, way), distance = std::sqrt(squared);
    if (!(squared > 0) || distance < near) continue;
    const float received = glm::dot(way, place.shading) / distance,
                sent = -glm::dot(way, light.normal) / distance;
    if (!(received > 0) || !(sent > 0) || glm::dot(way, place.geometric) <= 0) continue;
    const Point from = trace::offsetOrigin(place.position, place.geometric),
                to = trace::offsetOrigin(light.position, light.normal);
    const float length = glm::length(to - from);
    if (!(length > 0) ||
        scene.tracer.occluded({from, (to - from) / length, length * kShortOfLight}, hashCombine(stream, i)))
      continue;
    const Vec3 t = light.power * (kInvPi * received * sent / squared);
    for (std::size_t c = 0; c < 3; ++c) row[c * entries + light.entry] += t[static_cast<int>(c)];
  }
}

}  // namespace relume::transport
