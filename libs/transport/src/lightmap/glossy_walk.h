// SPDX-License-Identifier: MIT
// What the glossy lobes of a surface send into one direction: light that they see of emitters, and shares of
// what diffuse surfaces send out that they mirror, in one reflection or several.
#pragma once
#include <cstdint>
#include <vector>

#include "lightmap/radiance_cache.h"
#include "lightmap/reflection_step.h"

namespace relume::transport {

class GlossyWalk {
 public:
  struct End {
    SideOfTexel surface;
    Vec3 share;  ///< of the radiance that it sends out diffusely
  };

  /// Keeps references.
  GlossyWalk(const trace::Tracer& tracer, const TexelLookup& lookup, const Exposure& exposure,
             const Emitters& emitters, const RadianceCache& cache)
      : tracer_(tracer), lookup_(lookup), exposure_(exposure), cache_(cache), step_(tracer, emitters) {}

  /// One sample of the radiance that the glossy lobes at `hit` send along `outgoing` (unit): what is
  /// returned, of emitters, and the sum over `ends`. It goes on from surfaces whose glossy lobes are not part
  /// of what the cache knows. Light of emitters by sampling them and by chance, combined.
  Vec3 follow(const scene::Hit& hit, Direction outgoing, PathSampler& sampler, std::vector<End>& ends);

  std::uint64_t rays() const { return step_.rays(); }

 private:
  const trace::Tracer& tracer_;
  const TexelLookup& lookup_;
  const Exposure& exposure_;
  const RadianceCache& cache_;
  ReflectionStep step_;
};

}  // namespace relume::transport
