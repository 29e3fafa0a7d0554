// SPDX-License-Identifier: MIT
// Rays that know translucent surfaces apart from solid ones, so that BLEND materials are composited in order
// instead of being chosen at random.
//
// The scene's tracer meets a BLEND surface with the probability of its opacity. A second tracer over the
// static BLEND surfaces alone, in which they are opaque, finds all of them along a ray; the scene's tracer,
// which is sent on when it stops at one of them, finds the first solid surface. Limits: BLEND surfaces of
// dynamic instances keep the tracer's random choice (right in the mean over samples). Of several BLEND
// surfaces in one plane one is seen.
#pragma once
#include <memory>
#include <span>
#include <vector>

#include "relume/trace/tracer.h"

namespace relume::picture {

/// A surface that a ray passes through.
struct Translucent {
  scene::Hit where;
  float t = 0;        ///< metres along the ray
  float opacity = 0;  ///< (0, 1)
};

class LayeredTracer {
 public:
  static constexpr int kMaxLayers = 16;

  /// Keeps a reference to `tracer`.
  explicit LayeredTracer(const trace::Tracer& tracer);
  ~LayeredTracer();

  const trace::Tracer& tracer() const { return tracer_; }
  const scene::Scene& scene() const { return tracer_.scene(); }

  /// The first hit of each ray that is not a translucent surface. Rays with t_max < 0 hit nothing. At most
  /// Tracer::kPacket rays.
  void firstSolid(std::span<const trace::Ray> rays, std::span<const std::uint32_t> seeds,
                  std::span<trace::RayHit> hits) const;
  /// Appends what the ray passes before t_end, nearest first; at most kMaxLayers, and none behind a surface
  /// of opacity 1.
  void translucent(const trace::Ray& ray, float t_end, std::vector<Translucent>& layers) const;
  /// Share of light that gets from one end of each ray to the other: 0 behind solid surfaces, the product of
  /// (1 - opacity) of translucent ones. Rays with t_max < 0: 0.
  void transmittance(std::span<const trace::Ray> rays, std::span<const std::uint32_t> seeds,
                     std::span<float> transmittances) const;

 private:
  struct BlendScene;
  bool isTranslucent(const trace::RayHit& hit) const;
  trace::RayHit firstSolid(const trace::Ray& ray, std::uint32_t seed, trace::RayHit hit) const;

  const trace::Tracer& tracer_;
  std::vector<std::uint8_t> blend_instance_;  ///< 1: in `blend_`
  std::unique_ptr<BlendScene> blend_;         ///< null when nothing is translucent
};

}  // namespace relume::picture
