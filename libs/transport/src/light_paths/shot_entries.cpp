// SPDX-License-Identifier: MIT
#include "light_paths/shot_entries.h"

#include <algorithm>
#include <cmath>

#include "relume/core/frame.h"
#include "relume/core/parallel.h"
#include "relume/core/quantity.h"
#include "relume/core/sampling.h"

namespace relume::transport {
namespace {

constexpr std::uint32_t kPilotRays = 64;  // of a test point

std::uint32_t rayStream(std::uint64_t seed, std::size_t test_point) {
  return streamOf(seed, static_cast<std::uint32_t>(test_point), 0x73686f74u);
}

}  // namespace

float ShotRays::density(Direction way) const {
  return aim ? std::max(glm::dot(way, *aim), 0.0f) * kInvPi : 0.25f * kInvPi;
}

Direction ShotRays::direction(Vec2 u) const {
  return aim ? Frame::about(*aim).toWorld(squareToCosineHemisphere(u)) : squareToSphere(u);
}

float entryDensity(const trace::Tracer& tracer, const ShotRays& rays, Point position, Normal normal,
                   std::optional<std::size_t> seen_from) {
  const Point start = trace::offsetOrigin(position, normal);
  double sum = 0;
  for (std::size_t m = 0; m < rays.from.size(); ++m) {
    const Vec3 way = rays.from[m] - position;
    const float length = glm::length(way);
    if (!(length > 0)) continue;
    const float cosine = glm::dot(way, normal) / length, density = rays.density(-way / length);
    if (!(cosine > 0) || !(density > 0)) continue;
    if (m != seen_from) {
      const Vec3 back = rays.from[m] - start;
      const float distance = glm::length(back);
      if (tracer.occluded({start, back / distance, distance}, static_cast<std::uint32_t>(m))) continue;
    }
    sum += static_cast<double>(density) * static_cast<double>(cosine) /
           (static_cast<double>(length) * static_cast<double>(length));
  }
  return static_cast<float>(sum * rays.each);
}

std::vector<ShotEntry> shootEntries(const trace::Tracer& tracer, const ShotRays& rays, std::uint64_t seed,
                                    Progress& progress) {
  std::vector<ShotEntry> shot(rays.from.size() * rays.each);
  const Stage stage(progress, "entries", shot.size());
  parallelFor(
      shot.size(), 16,
      [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
          const std::size_t m = i / rays.each;
          const Vec2 u = sobol2(static_cast<std::uint32_t>(i % rays.each), rayStream(seed, m));
          const trace::Ray ray{rays.from[m], rays.direction(u), kInfinity};
          const trace::RayHit hit = tracer.intersect(ray, static_cast<std::uint32_t>(i));
          if (!hit) continue;
          ShotEntry& e = shot[i];
          e.normal = scene::geometricNormal(tracer.scene(), hit.where.instance, hit.where.triangle);
          if (glm::dot(e.normal, ray.direction) > 0) e.normal = -e.normal;
          e.position = scene::worldPosition(tracer.scene(), hit.where);
          e.density = entryDensity(tracer, rays, e.position, e.normal, m);
          e.from = ray.origin;
          // Rays in the plane of a surface; nothing can be made of what they meet.
          if (e.density > 0 && e.density < kInfinity) e.where = hit.where;
        }
      },
      &progress);
  std::erase_if(shot, [](const ShotEntry& e) { return e.where.instance == scene::kNone; });
  return shot;
}

std::uint32_t raysForEntries(const trace::Tracer& tracer, const ShotRays& rays, std::size_t count,
                             std::uint64_t seed) {
  std::size_t met = 0;
  for (std::size_t m = 0; m < rays.from.size(); ++m)
    for (std::uint32_t i = 0; i < kPilotRays; ++i)
      met += static_cast<bool>(
          tracer.intersect({rays.from[m], rays.direction(sobol2(i, rayStream(~seed, m))), kInfinity}, i));
  const double each = static_cast<double>(met) / kPilotRays;  // hits of one ray from every test point
  return each > 0 ? static_cast<std::uint32_t>(
                        std::clamp(std::round(static_cast<double>(count) / each), 1.0, 65536.0))
                  : 1u;
}

}  // namespace relume::transport
