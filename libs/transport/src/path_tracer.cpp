// SPDX-License-Identifier: MIT
#include "path_tracer.h"

#include <algorithm>
#include <cmath>

#include "power_heuristic.h"

namespace relume::transport {
namespace {

constexpr int kFirstRoulette = 3;       // bounces before paths may end by chance
constexpr float kMostSurvival = 0.95f;  // so that a path ends even between perfect mirrors
constexpr int kMostPasses = 64;         // panes of glass along one ray
constexpr float kShortOfLight = 1.0f - 1e-5f;

float largest(Vec3 v) { return std::max({v.x, v.y, v.z}); }

}  // namespace

PathTracer::PathTracer(const trace::Tracer& tracer, const Emitters& emitters, const ReferenceOptions& options)
    : tracer_(tracer), scene_(tracer.scene()), emitters_(emitters), options_(options) {
  for (const scene::Material& material : scene_.materials)
    any_transmission_ |= material.transmission > 0 && !material.unlit;
}

const scene::Material& PathTracer::materialOf(const scene::Hit& hit) const {
  return scene_.materials[scene_.meshes[scene_.instances[hit.instance].mesh].material];
}

Vec3 PathTracer::visibility(const Vertex& vertex, const LightSample& light, std::uint32_t alpha_seed) const {
  trace::Ray ray{trace::offsetOrigin(vertex.position, vertex.geometric), light.direction, kInfinity};
  if (!light.endless) {
    const Vec3 way = light.end - ray.origin;
    const float distance = glm::length(way);
    if (!(distance > 0)) return Vec3(1.0f);
    ray.direction = way / distance, ray.t_max = distance * kShortOfLight;
  }
  if (!any_transmission_) return Vec3(tracer_.occluded(ray, alpha_seed) ? 0.0f : 1.0f);
  Vec3 passed(1.0f);
  for (int pass = 0; pass < kMostPasses; ++pass) {
    const trace::RayHit hit = tracer_.intersect(ray, alpha_seed);
    if (!hit) return passed;
    if (!(materialOf(hit.where).transmission > 0)) return Vec3(0.0f);
    const Vertex pane = vertexAt(scene_, hit.where, -ray.direction, options_.materials);
    passed *= pane.transmittance;
    if (passed == Vec3(0)) return passed;
    ray.origin = trace::offsetOrigin(pane.position, -pane.geometric);
    ray.t_max -= hit.t;
  }
  return Vec3(0.0f);
}

Vec3 PathTracer::sampledLight(const Vertex& vertex, PathSampler& sampler) {
  Vec3 sum(0.0f);
  for (const Reach reach : {Reach::kLocal, Reach::kDistant})
    if (emitters_.has(reach)) sum += sampledLight(reach, vertex, sampler);
  return sum;
}

Vec3 PathTracer::sampledLight(Reach reach, const Vertex& vertex, PathSampler& sampler) {
  const Vec2 place = sampler.pair();
  const float choice = sampler.pair().x;
  const std::uint32_t alpha_seed = sampler.bits();
  const LightSample light = emitters_.sample(reach, vertex.position, vertex.geometric, place, choice);
  if (!(light.pdf > 0) || !(glm::dot(light.direction, vertex.geometric) > 0)) return Vec3(0.0f);
  const Vec3 value = vertex.bsdf.evaluate(light.direction) * light.value / light.pdf;
  if (value == Vec3(0)) return value;
  float weight = 1.0f;
  if (!light.delta && options_.estimator == Estimator::kMis)
    weight = powerHeuristic(light.pdf, vertex.bsdf.pdf(light.direction));
  return value * weight * visibility(vertex, light, alpha_seed);
}

template <class Emitted>
PathTracer::Arrival PathTracer::follow(Point from, Normal side, trace::Ray ray, PathSampler& sampler,
                                       const Emitted& emitted) {
  Arrival arrival;
  float travelled = 0;
  const std::uint32_t alpha_seed = sampler.bits();
  for (int pass = 0; pass < kMostPasses; ++pass) {
    const trace::RayHit hit = tracer_.intersect(ray, alpha_seed);
    seen_.clear();
    emitters_.onRay(from, side, ray.direction, travelled, hit ? travelled + hit.t : kInfinity, seen_);
    for (const LightSeen& light : seen_) emitted(light, arrival.throughput);
    if (!hit) return arrival;
    travelled += hit.t;
    arrival.vertex = vertexAt(scene_, hit.where, -ray.direction, options_.materials);
    const LightSeen light =
        emitters_.onSurface(from, side, ray.direction, hit.where, travelled, hit.back_face);
    if (light.radiance.rgb != Vec3(0)) emitted(light, arrival.throughput);
    // A pane: through it by chance, or reflected.
    const float through = std::min(largest(arrival.vertex.transmittance), 1.0f);
    if (through > 0 && sampler.pair().x < through) {
      arrival.throughput *= arrival.vertex.transmittance / through;
      ray.origin = trace::offsetOrigin(arrival.vertex.position, -arrival.vertex.geometric);
      continue;
    }
    if (through > 0) arrival.throughput /= 1 - through;
    arrival.hit = true;
    return arrival;
  }
  return arrival;
}

Vec3 PathTracer::reflected(Vertex vertex, PathSampler& sampler) {
  Vec3 sum(0.0f), throughput(1.0f);
  for (int bounce = 0;; ++bounce) {
    if (vertex.bsdf.black()) break;
    const bool counts = options_.part == Part::kTotal || (options_.part == Part::kDirect) == (bounce == 0);
    if (counts && options_.estimator != Estimator::kBsdfOnly)
      sum += throughput * sampledLight(vertex, sampler);

    const Vec2 u = sampler.pair(), chances = sampler.pair();
    const BsdfSample next = vertex.bsdf.sample(u, chances.x);
    if (!(next.pdf > 0) || !(glm::dot(next.direction, vertex.geometric) > 0)) break;
    throughput *= next.weight;
    if (bounce >= kFirstRoulette) {
      const float survival = std::min(largest(throughput), kMostSurvival);
      if (!(chances.y < survival)) break;
      throughput /= survival;
    }
    const Point origin = trace::offsetOrigin(vertex.position, vertex.geometric);
    const Arrival arrival = follow(vertex.position, vertex.geometric, {origin, next.direction}, sampler,
                                   [&](const LightSeen& light, Vec3 passed) {
                                     if (!counts || options_.estimator == Estimator::kLightOnly) return;
                                     const float weight = options_.estimator == Estimator::kMis
                                                              ? powerHeuristic(next.pdf, light.pdf)
                                                              : 1.0f;
                                     sum += throughput * passed * light.radiance.rgb * weight;
                                   });
    if (!arrival.hit || (options_.part == Part::kDirect)) break;
    if (options_.max_bounces >= 0 && bounce >= options_.max_bounces) break;
    throughput *= arrival.throughput;
    vertex = arrival.vertex;
  }
  return sum;
}

Vec3 PathTracer::irradiance(const Receiver& receiver, PathSampler& sampler) {
  // E = integral of L cos, i.e. pi times what a white diffuse reflector sends out.
  Vertex vertex;
  vertex.position = receiver.position, vertex.geometric = receiver.geometric_normal;
  vertex.bsdf = Bsdf::lambert(receiver.shading_normal, Vec3(1.0f));
  return kPi * reflected(vertex, sampler);
}

Vec3 PathTracer::radiance(const trace::Ray& primary, PathSampler& sampler) {
  Vec3 sum(0.0f);
  const bool sees_emitters = options_.part != Part::kIndirect;
  const std::uint32_t alpha_seed = sampler.bits();
  // What is unlit shows its colour; asked first, for `follow` takes it as black.
  const trace::RayHit first = tracer_.intersect(primary, alpha_seed);
  if (first && materialOf(first.where).unlit)
    return sees_emitters ? Vec3(scene::surfaceAt(scene_, first.where).base_colour) : Vec3(0.0f);
  const Arrival arrival =
      follow(primary.origin, Normal(0), primary, sampler, [&](const LightSeen& light, Vec3 passed) {
        if (sees_emitters) sum += passed * light.radiance.rgb;
      });
  if (arrival.hit) return sum + arrival.throughput * reflected(arrival.vertex, sampler);
  if (sees_emitters && scene_.environment.dark()) sum += arrival.throughput * options_.background;
  return sum;
}

}  // namespace relume::transport
