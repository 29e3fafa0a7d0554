// SPDX-License-Identifier: MIT
// What a surface sends to a place that is nearer to it than a texel is long. There its texel's mean is not
// good enough: the foot of a wall is lit by the part of the floor beside it, and of the frame around a bright
// window by what lies in the corner between the two. So the radiance of near ends of rays is not looked up,
// but found at the place where they end, by light samples there and a ray more, which ends in the cache if it
// ends far away. Without this, texels in the gaps of a window's frame had half of their light.
#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "lightmap/glossy_walk.h"

namespace relume::transport {

class NearWalk {
 public:
  /// Keeps references. For light of any number of bounces. `reach`: as reaches() tells.
  NearWalk(const trace::Tracer& tracer, std::span<const float> reach, const TexelLookup& lookup,
           const Exposure& exposure, const Emitters& emitters, const RadianceCache& cache,
           Materials materials)
      : tracer_(tracer),
        reach_(reach),
        lookup_(lookup),
        exposure_(exposure),
        cache_(cache),
        materials_(materials),
        step_(tracer, emitters),
        glossy_(tracer, lookup, exposure, emitters, cache) {}

  /// By point: rays that end in its texel before this way are near, in metres.
  static std::vector<float> reaches(const atlas::Texels& texels, const RadianceCache& cache);

  /// One sample of the radiance that is reflected at `hit` along `outgoing` (unit).
  Vec3 follow(const scene::Hit& hit, Direction outgoing, PathSampler& sampler);

  std::uint64_t rays() const { return step_.rays() + glossy_.rays(); }

 private:
  /// What the cache knows of the end of a ray, and what glossy lobes there send besides.
  Vec3 cached(const ReflectionStep::Result& step, PathSampler& sampler);

  const trace::Tracer& tracer_;
  const std::span<const float> reach_;
  const TexelLookup& lookup_;
  const Exposure& exposure_;
  const RadianceCache& cache_;
  const Materials materials_;
  ReflectionStep step_;
  GlossyWalk glossy_;
  std::vector<GlossyWalk::End> ends_;
};

}  // namespace relume::transport
