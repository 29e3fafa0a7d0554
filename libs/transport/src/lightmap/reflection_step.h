// SPDX-License-Identifier: MIT
// One reflection of a random walk that ends in the radiance cache.
#pragma once
#include <cstdint>
#include <vector>

#include "path_sampler.h"
#include "relume/trace/tracer.h"
#include "relume/transport/emitters.h"
#include "vertex.h"

namespace relume::transport {

class ReflectionStep {
 public:
  struct Result {
    Vec3 light{0.0f};   ///< of emitters, reflected towards the outgoing direction
    Vec3 weight{0.0f};  ///< of the radiance that comes from `found`; 0: nothing goes on
    trace::RayHit found;
    Point origin{0.0f};  ///< of the ray that found it
    Direction direction{0, 0, 1};
  };

  /// Keeps references.
  ReflectionStep(const trace::Tracer& tracer, const Emitters& emitters)
      : tracer_(tracer), emitters_(emitters) {}

  /// One sample of what `lobes`, some of the vertex's, reflect. Light of emitters by sampling them and by
  /// chance, combined (power_heuristic.h).
  Result take(const Vertex& vertex, const Bsdf& lobes, PathSampler& sampler);

  std::uint64_t rays() const { return traced_; }

 private:
  Vec3 sampledLight(const Vertex& vertex, const Bsdf& lobes, PathSampler& sampler);

  const trace::Tracer& tracer_;
  const Emitters& emitters_;
  std::vector<LightSeen> seen_;
  std::uint64_t traced_ = 0;
};

}  // namespace relume::transport
