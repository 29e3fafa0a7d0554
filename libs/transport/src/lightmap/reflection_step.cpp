// SPDX-License-Identifier: MIT
#include "lightmap/reflection_step.h"

#include "power_heuristic.h"

namespace relume::transport {
namespace {

constexpr float kShortOfLight = 1.0f - 1e-5f;

}  // namespace

Vec3 ReflectionStep::sampledLight(const Vertex& vertex, const Bsdf& lobes, PathSampler& sampler) {
  Vec3 sum(0.0f);
  for (const Reach reach : {Reach::kLocal, Reach::kDistant}) {
    if (!emitters_.has(reach)) continue;
    const Vec2 place = sampler.pair();
    const float choice = sampler.pair().x;
    const std::uint32_t alpha_seed = sampler.bits();
    const LightSample light = emitters_.sample(reach, vertex.position, vertex.geometric, place, choice);
    if (!(light.pdf > 0) || !(glm::dot(light.direction, vertex.geometric) > 0)) continue;
    Vec3 value = lobes.evaluate(light.direction) * light.value / light.pdf;
    if (!light.delta) value *= powerHeuristic(light.pdf, lobes.pdf(light.direction));
    if (value == Vec3(0)) continue;
    trace::Ray ray{trace::offsetOrigin(vertex.position, vertex.geometric), light.direction, kInfinity};
    if (!light.endless) {
      const Vec3 way = light.end - ray.origin;
      const float distance = glm::length(way);
      if (distance > 0) ray.direction = way / distance, ray.t_max = distance * kShortOfLight;
    }
    ++traced_;
    if (!tracer_.occluded(ray, alpha_seed)) sum += value;
  }
  return sum;
}

ReflectionStep::Result ReflectionStep::take(const Vertex& vertex, const Bsdf& lobes, PathSampler& sampler) {
  Result result;
  result.light = sampledLight(vertex, lobes, sampler);
  const Vec2 u = sampler.pair();
  const BsdfSample next = lobes.sample(u, sampler.pair().x);
  if (!(next.pdf > 0) || !(glm::dot(next.direction, vertex.geometric) > 0)) return result;
  result.origin = trace::offsetOrigin(vertex.position, vertex.geometric), result.direction = next.direction;
  const trace::RayHit found = tracer_.intersect({result.origin, next.direction}, sampler.bits());
  ++traced_;
  seen_.clear();
  emitters_.onRay(vertex.position, vertex.geometric, next.direction, 0.0f, found ? found.t : kInfinity,
                  seen_);
  if (found)
    seen_.push_back(emitters_.onSurface(vertex.position, vertex.geometric, next.direction, found.where,
                                        found.t, found.back_face));
  for (const LightSeen& light : seen_)
    result.light += next.weight * light.radiance.rgb * powerHeuristic(next.pdf, light.pdf);
  if (found) result.found = found, result.weight = next.weight;
  return result;
}

}  // namespace relume::transport
