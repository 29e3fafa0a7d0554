// SPDX-License-Identifier: MIT
// What the glossy lobes of a surface send into one direction: light that they see of emitters, and shares of
// what diffuse surfaces send out that they mirror, in one reflection or several.
#pragma once
#include <cstdint>
#include <vector>

#include "lightmap/radiance_cache.h"
#include "path_sampler.h"
#include "relume/transport/emitters.h"
#include "vertex.h"

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
      : tracer_(tracer), lookup_(lookup), exposure_(exposure), emitters_(emitters), cache_(cache) {}

  /// One sample of the radiance that the glossy lobes at `hit` send along `outgoing` (unit): what is
  /// returned, of emitters, and the sum over `ends`. It goes on from surfaces whose glossy lobes are not part
  /// of what the cache knows. Light of emitters by sampling them and by chance, combined.
  Vec3 follow(const scene::Hit& hit, Direction outgoing, PathSampler& sampler, std::vector<End>& ends);

  std::uint64_t rays() const { return traced_; }

 private:
  Vec3 sampledLight(const Vertex& vertex, const Bsdf& lobes, PathSampler& sampler);

  const trace::Tracer& tracer_;
  const TexelLookup& lookup_;
  const Exposure& exposure_;
  const Emitters& emitters_;
  const RadianceCache& cache_;
  std::vector<LightSeen> seen_;
  std::uint64_t traced_ = 0;
};

}  // namespace relume::transport
