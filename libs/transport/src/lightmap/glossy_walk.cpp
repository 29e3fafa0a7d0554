// SPDX-License-Identifier: MIT
#include "lightmap/glossy_walk.h"

#include <algorithm>

namespace relume::transport {
namespace {

constexpr int kMostReflections = 256;
constexpr float kLeastSurvival = 0.05f, kMostSurvival = 0.95f;  // so that walks between mirrors end

}  // namespace

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
    const ReflectionStep::Result step = step_.take(vertex, lobes, sampler);
    sum += share * step.light;
    if (step.weight == Vec3(0)) break;
    share *= step.weight, origin = step.origin;
    where = step.found.where, outgoing = -step.direction;
  }
  return sum;
}

}  // namespace relume::transport
