// SPDX-License-Identifier: MIT
#include "shadows.h"

#include "relume/core/parallel.h"
#include "relume/core/sampling.h"

namespace relume::app {
namespace {

constexpr std::uint32_t kAreaSamples = 16;
constexpr std::size_t kGrain = 256;  // texels per task

float visibilityOf(const trace::Tracer& tracer, const Light& light, Point p, Normal n, std::uint32_t item) {
  const Point origin = trace::offsetOrigin(p, n);
  if (light.kind == Light::Kind::kDirectional)
    return tracer.occluded({.origin = origin, .direction = -light.direction}, item) ? 0.0f : 1.0f;
  const bool area = light.kind == Light::Kind::kArea && light.area > 0;
  const std::uint32_t samples = area ? kAreaSamples : 1;
  std::uint32_t seen = 0;
  for (std::uint32_t s = 0; s < samples; ++s) {
    const Vec3 to_light = pointOn(light, sobol2(s, item)) - origin;
    const float distance = glm::length(to_light);
    if (!(distance > 0)) continue;
    const trace::Ray ray{.origin = origin, .direction = to_light / distance, .t_max = distance * 0.999f};
    seen += !tracer.occluded(ray, hashCombine(item, s));
  }
  return static_cast<float>(seen) / static_cast<float>(samples);
}

}  // namespace

relight::VisibilitySource tracedVisibility(const trace::Tracer& tracer, std::span<const Point> points,
                                           std::span<const Normal> normals, const LightSet& lights) {
  return [&tracer, points, normals, &lights](std::size_t light, std::span<float> visibility) {
    parallelFor(visibility.size(), kGrain, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        const bool faces = glm::dot(normals[i], directionTo(lights[light], points[i])) > 0;
        visibility[i] =
            faces ? visibilityOf(tracer, lights[light], points[i], normals[i], static_cast<std::uint32_t>(i))
                  : 0.0f;
      }
    });
  };
}

}  // namespace relume::app
