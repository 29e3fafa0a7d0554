// SPDX-License-Identifier: MIT
#include "verification_places.h"

#include <algorithm>
#include <cmath>

#include "relume/core/frame.h"
#include "relume/core/sampling.h"

namespace relume::app {
namespace {

/// Another surface lies in the same plane: what is true there depends on which of the two is asked.
bool coincides(const trace::Tracer& tracer, const scene::Hit& own, float diagonal) {
  const scene::Scene& scene = tracer.scene();
  const Point p = scene::worldPosition(scene, own);
  const Normal n = scene::geometricNormal(scene, own.instance, own.triangle);
  const float near = 3e-5f * diagonal;
  trace::Ray ray{p + near * n, -n, 2 * near};
  for (int layer = 0; layer < 4; ++layer) {
    const trace::RayHit hit = tracer.intersect(ray);
    if (!hit) return false;
    if (hit.where.instance != own.instance || hit.where.triangle != own.triangle) return true;
    ray.origin = trace::offsetOrigin(p, -n);
    ray.t_max = near;
  }
  return false;
}

/// Inside a body, where no eye is: what a texel that reaches in there holds is the value beside it.
bool buried(const trace::Tracer& tracer, const scene::Hit& own, std::uint32_t stream) {
  constexpr std::uint32_t kRays = 16, kBacks = 4;
  const Normal n = scene::geometricNormal(tracer.scene(), own.instance, own.triangle);
  const Point origin = trace::offsetOrigin(scene::worldPosition(tracer.scene(), own), n);
  const Frame frame = Frame::about(n);
  std::uint32_t backs = 0;
  for (std::uint32_t i = 0; i < kRays; ++i)
    backs += tracer.intersect({origin, frame.toWorld(squareToCosineHemisphere(sobol2(i, stream)))}).back_face;
  return backs > kBacks;
}

}  // namespace

std::vector<VerifiedPlace> choosePlaces(const trace::Tracer& tracer, const picture::BakedValues& baked,
                                        const VerifyOptions& options, std::size_t& skipped) {
  const scene::Scene& scene = tracer.scene();
  const float diagonal = scene.bounds().diagonal();
  const SurfaceSampler surface(scene);
  std::vector<VerifiedPlace> places;
  if (surface.empty()) return places;
  for (std::uint32_t k = 0; k < options.points; ++k) {
    const std::uint32_t stream = streamOf(options.seed, 0, 0);
    const double share = (k + static_cast<double>(sobol2(k, stream).x)) / options.points;
    const scene::Hit hit = surface.at(share, sobol2(k, stream + 1));
    const auto place = baked.locate(hit);
    const auto index = place ? baked.tableIndex(*place) : std::nullopt;
    if (!index || !baked.table().valid[*index] || scene::opacityAt(scene, hit) < 0.5f ||
        scene::geometricNormal(scene, hit.instance, hit.triangle) == Normal(0) ||
        coincides(tracer, hit, diagonal) || buried(tracer, hit, stream + 2)) {
      ++skipped;
      continue;
    }
    places.push_back({hit, static_cast<double>(luminance(baked.value(*place)))});
  }
  return places;
}

}  // namespace relume::app
