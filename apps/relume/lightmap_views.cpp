// SPDX-License-Identifier: MIT
#include "lightmap_views.h"

#include <algorithm>
#include <cmath>

#include "lightmap_truth.h"
#include "relume/core/parallel.h"
#include "relume/core/sampling.h"
#include "relume/picture/baked_values.h"
#include "relume/picture/primary_rays.h"

namespace relume::app {
namespace {

constexpr int kAlong = 2;  // places along the side of a pixel
constexpr std::uint32_t kPlaces = kAlong * kAlong;
constexpr std::size_t kGrain = 1024;

/// What is seen at one place of the picture: `colour` E + `own`.
struct Seen {
  Vec3 own{0.0f}, colour{0.0f};
  Vec3 baked{0.0f};  // irradiance
  transport::Receiver receiver;
};

Seen seenAlong(const trace::Tracer& tracer, const picture::BakedValues& baked, const trace::Ray& ray,
               std::uint32_t alpha_seed, Vec3 background) {
  const scene::Scene& scene = tracer.scene();
  const trace::RayHit hit = tracer.intersect(ray, alpha_seed);
  if (!hit) return {.own = background};
  const scene::Surface surface = scene::surfaceAt(scene, hit.where);
  const Vec3 base(surface.base_colour);
  Seen seen{.own = surface.emission.rgb};
  const auto place = baked.locate(hit.where);
  if (scene.materials[scene.meshes[scene.instances[hit.where.instance].mesh].material].unlit || !place) {
    seen.own += base;
    return seen;
  }
  seen.colour = base * kInvPi;
  seen.baked = baked.value(*place);
  transport::Receiver& r = seen.receiver;
  r.position = scene::worldPosition(scene, hit.where);
  r.geometric_normal = scene::geometricNormal(scene, hit.where.instance, hit.where.triangle);
  r.shading_normal = scene::shadingNormal(scene, hit.where);
  if (glm::dot(r.geometric_normal, ray.direction) > 0)
    r.geometric_normal = -r.geometric_normal, r.shading_normal = -r.shading_normal;
  return seen;
}

}  // namespace

std::uint32_t samplesOfPlace(const ViewOptions& options) {
  return std::max(options.samples / (2 * kPlaces), 1u);
}

ComparedView lightmapView(const transport::Reference& reference, const asset::Asset& asset,
                          const asset::Layer& layer, const picture::Viewpoint& viewpoint,
                          const ViewOptions& options, std::uint64_t seed, Progress& progress) {
  const picture::BakedValues baked(reference.tracer().scene(), &asset, picture::View::kLightmap, layer.name);
  return comparedView(reference, {baked, truthOf(layer, samplesOfPlace(options), seed), {}}, viewpoint,
                      options, seed, progress);
}

ComparedView comparedView(const transport::Reference& reference, const ComparedLight& light,
                          const picture::Viewpoint& viewpoint, const ViewOptions& options, std::uint64_t seed,
                          Progress& progress) {
  const trace::Tracer& tracer = reference.tracer();
  const picture::PrimaryRays rays(viewpoint, options.size.x, options.size.y);
  const auto width = static_cast<std::size_t>(options.size.x),
             height = static_cast<std::size_t>(options.size.y);
  ComparedView view;

  std::vector<Seen> seen(width * height * kPlaces);
  parallelFor(seen.size(), kGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const std::size_t pixel = i / kPlaces, k = i % kPlaces;
      const Vec2 corner(static_cast<float>(pixel % width), static_cast<float>(pixel / width));
      const Vec2 inside = (Vec2(static_cast<float>(k % kAlong), static_cast<float>(k / kAlong)) + 0.5f) /
                          static_cast<float>(kAlong);
      seen[i] = seenAlong(tracer, light.baked, rays.at(corner + inside),
                          hashCombine(static_cast<std::uint32_t>(seed), static_cast<std::uint32_t>(i)),
                          view.background);
      if (light.besides && seen[i].colour != Vec3(0)) seen[i].baked += light.besides(seen[i].receiver);
    }
  });

  std::vector<transport::Receiver> receivers;
  for (const Seen& s : seen)
    if (s.colour != Vec3(0)) receivers.push_back(s.receiver);
  transport::ReferenceOptions truth = light.truth;
  const auto first = reference.irradiance(receivers, truth, progress);
  truth.seed = independentSeed(seed);
  const auto second = reference.irradiance(receivers, truth, progress);

  view.baked = view.truth = view.other_truth = image::Image(options.size.x, options.size.y, 3);
  std::size_t next = 0;
  for (std::size_t pixel = 0; pixel < width * height; ++pixel) {
    Vec3 by_bake(0.0f), by_first(0.0f), by_second(0.0f);
    for (std::size_t k = 0; k < kPlaces; ++k) {
      const Seen& s = seen[pixel * kPlaces + k];
      by_bake += s.own + s.colour * s.baked;
      const bool lit = s.colour != Vec3(0);
      by_first += s.own + (lit ? s.colour * first.value[next].rgb : Vec3(0.0f));
      by_second += s.own + (lit ? s.colour * second.value[next].rgb : Vec3(0.0f));
      next += lit;
    }
    const int x = static_cast<int>(pixel % width), y = static_cast<int>(pixel / width);
    constexpr float kShare = 1.0f / kPlaces;
    view.baked.setRgb(x, y, by_bake * kShare);
    view.truth.setRgb(x, y, by_first * kShare), view.other_truth.setRgb(x, y, by_second * kShare);
  }
  return view;
}

}  // namespace relume::app
