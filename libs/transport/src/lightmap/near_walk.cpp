// SPDX-License-Identifier: MIT
#include "lightmap/near_walk.h"

#include <algorithm>
#include <cmath>

namespace relume::transport {
namespace {

constexpr float kNear = 1.5f;  // texels, of those that are no brighter than most
constexpr float kMostMatter = 64.0f;
constexpr int kMostReflections = 256, kFirstRoulette = 3;
constexpr float kMostSurvival = 0.95f;  // so that walks in narrow white gaps end

}  // namespace

std::vector<float> NearWalk::reaches(const atlas::Texels& texels, const RadianceCache& cache) {
  std::vector<float> bright(texels.points.size()), reach(bright.size());
  double sum = 0;
  for (std::uint32_t i = 0; i < bright.size(); ++i) {
    bright[i] = luminance(cache.radiance(i));
    sum += static_cast<double>(bright[i]);
  }
  const float mean = static_cast<float>(sum / std::max<double>(static_cast<double>(bright.size()), 1.0));
  for (std::uint32_t i = 0; i < reach.size(); ++i) {
    const atlas::SurfacePoint& p = texels.points[i];
    const float size = std::sqrt(glm::length(glm::cross(p.dp_dx, p.dp_dy)));
    // What a texel gives to another falls with the square of the distance.
    const float matter = std::sqrt(std::clamp(bright[i] / std::max(mean, 1e-30f), 1.0f, kMostMatter));
    reach[i] = kNear * size * matter;
  }
  return reach;
}

Vec3 NearWalk::cached(const ReflectionStep::Result& step, PathSampler& sampler) {
  const scene::Hit& where = step.found.where;
  const Point end = step.origin + step.found.t * step.direction;
  const bool behind =
      glm::dot(scene::geometricNormal(tracer_.scene(), where.instance, where.triangle), step.direction) > 0;
  Vec3 sum = cache_.radiance(endOf(where, behind, step.origin, end, lookup_, &exposure_));
  if (cache_.walkChance(lookup_.point(where)) == 0) return sum;
  sum += glossy_.follow(where, -step.direction, sampler, ends_);
  for (const GlossyWalk::End& e : ends_) sum += e.share * cache_.radiance(e.surface);
  return sum;
}

Vec3 NearWalk::follow(const scene::Hit& hit, Direction outgoing, PathSampler& sampler) {
  Vec3 sum(0.0f), share(1.0f);
  scene::Hit where = hit;
  for (int reflection = 0; reflection < kMostReflections; ++reflection) {
    const Vertex vertex = vertexAt(tracer_.scene(), where, outgoing, materials_);
    if (vertex.bsdf.black()) break;
    const ReflectionStep::Result step = step_.take(vertex, vertex.bsdf, sampler);
    sum += share * step.light;
    if (step.weight == Vec3(0)) break;
    share *= step.weight;
    where = step.found.where, outgoing = -step.direction;
    const std::uint32_t point = lookup_.point(where);
    if (point == scene::kNone) break;
    if (step.found.t > reach_[point]) return sum + share * cached(step, sampler);
    if (reflection < kFirstRoulette) continue;
    const float survival = std::min(std::max({share.x, share.y, share.z}), kMostSurvival);
    if (!(sampler.pair().x < survival)) break;
    share /= survival;
  }
  return sum;
}

}  // namespace relume::transport
