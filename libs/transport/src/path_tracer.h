// SPDX-License-Identifier: MIT
// One random walk: from the eye or from a lit point, with light sampled at each of its vertices.
#pragma once
#include <vector>

#include "path_sampler.h"
#include "relume/trace/tracer.h"
#include "relume/transport/emitters.h"
#include "relume/transport/reference.h"
#include "vertex.h"

namespace relume::transport {

class PathTracer {
 public:
  /// Keeps references.
  PathTracer(const trace::Tracer& tracer, const Emitters& emitters, const ReferenceOptions& options);

  /// One sample of the radiance along a ray of the eye.
  Vec3 radiance(const trace::Ray& primary, PathSampler& sampler);
  /// One sample of E at the receiver.
  Vec3 irradiance(const Receiver& receiver, PathSampler& sampler);

 private:
  /// Where a ray ends.
  struct Arrival {
    bool hit = false;
    Vertex vertex;
    Vec3 throughput{1.0f};  ///< of what it passed
  };

  const scene::Material& materialOf(const scene::Hit& hit) const;
  /// Light that reaches `start` and is reflected there.
  Vec3 reflected(Vertex start, PathSampler& sampler);
  Vec3 sampledLight(const Vertex& vertex, PathSampler& sampler);
  Vec3 sampledLight(Reach reach, const Vertex& vertex, PathSampler& sampler);
  Vec3 visibility(const Vertex& vertex, const LightSample& light, std::uint32_t alpha_seed) const;
  /// Follows a ray through what transmits; `emitted` is called with (light seen, throughput so far).
  template <class Emitted>
  Arrival follow(Point from, Normal side, trace::Ray ray, PathSampler& sampler, const Emitted& emitted);

  const trace::Tracer& tracer_;
  const scene::Scene& scene_;
  const Emitters& emitters_;
  const ReferenceOptions& options_;
  bool any_transmission_ = false;
  std::vector<LightSeen> seen_;
};

}  // namespace relume::transport
