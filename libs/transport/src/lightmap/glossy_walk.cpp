// SPDX-License-Identifier: MIT
#include "lightmap/glossy_walk.h"

#include <algorithm>

#include "power_heuristic.h"

namespace relume::transport {
namespace {

constexpr int kMostReflections = 256;
constexpr float kLeastSurvival = 0.05f, kMostSurvival = 0.95f;  // so that walks between mirrors end
constexpr float kShortOfLight = 1.0f - 1e-5f;

}  // namespace

Vec3 GlossyWalk::sampledLight(const Vertex& vertex, const Bsdf& lobes, PathSampler& sampler) {
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

Vec3 GlossyWalk::follow(const scene::Hit& hit, Direction outgoing, PathSampler& sampler,
                        std::vector<End>& ends) {
  ends.clear();
  Vec3 sum(0.0f), share(1.0f);
  scene::Hit where = hit;
  Point origin(0.0f);
  for (int reflection = 0; reflection < kMostReflections; ++reflection) {
    const Vertex vertex = vertexAt(tracer_.scene(), where, outgoing, Materials::kFull);
    if (reflection > 0) {
      ends.push_back({endOf(where, vertex.behind, origin, vertex.position, lookup_, &exposure_), share});
      const std::uint32_t point = lookup_.point(where);
      if (point == scene::kNone || cache_.walkChance(point) == 0) break;
      const float survival = std::clamp(luminance(vertex.bsdf.glossyAlbedo()), kLeastSurvival, kMostSurvival);
      if (!(sampler.pair().x < survival)) break;
      share /= survival;
    }
    const Bsdf lobes = vertex.bsdf.glossy();
    if (lobes.black()) break;
    sum += share * sampledLight(vertex, lobes, sampler);
    const BsdfSample next = lobes.sample(sampler.pair(), 0.0f);
    if (!(next.pdf > 0) || !(glm::dot(next.direction, vertex.geometric) > 0)) break;
    share *= next.weight;
    origin = trace::offsetOrigin(vertex.position, vertex.geometric);
    const trace::RayHit found = tracer_.intersect({origin, next.direction}, sampler.bits());
    ++traced_;
    seen_.clear();
    emitters_.onRay(vertex.position, vertex.geometric, next.direction, 0.0f, found ? found.t : kInfinity,
                    seen_);
    if (found)
      seen_.push_back(emitters_.onSurface(vertex.position, vertex.geometric, next.direction, found.where,
                                          found.t, found.back_face));
    for (const LightSeen& light : seen_)
      sum += share * light.radiance.rgb * powerHeuristic(next.pdf, light.pdf);
    if (!found) break;
    where = found.where, outgoing = -next.direction;
  }
  return sum;
}

}  // namespace relume::transport
