// SPDX-License-Identifier: MIT
// The estimators of relume/transport/occlusion.h written down plainly, one ray at a time: the reference for
// the fast path.
#pragma once
#include "relume/core/frame.h"
#include "relume/core/sampling.h"
#include "relume/transport/occlusion.h"

namespace relume::transport::plain {

struct Estimate {
  Vec3 value{0};
  Vec3 bent{0};  ///< not normalised
  float back_share = 0;
};

/// `samples` rays from the footprint of a flat texel (sample_count 0).
inline Estimate occlusion(const trace::Tracer& tracer, const atlas::SurfacePoint& point,
                          const OcclusionOptions& options, std::uint32_t samples, std::uint32_t stream) {
  glm::dvec3 sum(0), bent(0);
  std::uint32_t kept = 0, back = 0;
  const Frame frame = Frame::about(point.shading_normal);
  for (std::uint32_t i = 0; i < samples; ++i) {
    const Direction d = frame.toWorld(squareToCosineHemisphere(sobol2(i, 2 * stream)));
    if (glm::dot(d, point.geometric_normal) <= 0.0f) continue;
    const Vec2 u = sobol2(i, 2 * stream + 1) - 0.5f;
    const Point p = point.position + u.x * point.dp_dx + u.y * point.dp_dy;
    const trace::RayHit hit =
        tracer.intersect({trace::offsetOrigin(p, point.geometric_normal), d, options.weight.limit}, i);
    const float rho = hit ? options.weight(hit.t) : 1.0f;
    Vec3 w(rho);
    if (hit && options.kind == OcclusionKind::kSpectral) {
      const Vec3 albedo = hit.back_face ? Vec3(0) : scene::surfaceAt(tracer.scene(), hit.where).albedo().rgb;
      for (int c = 0; c < 3; ++c) {
        const float mean = options.mean_albedo.rgb[c];
        w[c] *= mean > 0.0f ? albedo[c] / mean : 0.0f;
      }
    }
    ++kept, back += hit.back_face;
    sum += w;
    bent += glm::dvec3(w.x * d);
  }
  return {Vec3(sum / static_cast<double>(kept)), Vec3(bent / static_cast<double>(kept)),
          static_cast<float>(back) / static_cast<float>(kept)};
}

}  // namespace relume::transport::plain
