// SPDX-License-Identifier: MIT
// One scene under many lights: rays are traced once, and where they end is kept. Then each light costs shadow
// rays for what it lights directly, and sums over kept rays for all bounces. Based on:
//   [BDPTM] Bahnsen, Dewilde, Pedersen, Tranchet, Madsen. Realtime global illumination using compressed
//   pre-computed indirect illumination textures. What they bake frame by frame.
//   [RTR] Akenine-Moeller, Haines, Hoffman. Real-Time Rendering, 3rd ed. Section 11.2.1: radiosity with rays
//   for form factors.
// With E the irradiance, rho the reflectance, y(x, j) the place where ray j of texel x ends:
//   B_0 = rho / pi E_direct,  B_k(x) = rho / pi (E_direct(x) + pi / m sum_j<m B_(k-1)(y(x, j))),
//   result(x) = pi / n sum_j<n B_oo(y(x, j)),  where a ray that escapes ends in the sky, by direction.
// All lights share the rays, so what differs between two of them is light alone and no noise. What holds:
// bits do not depend on the number of threads. What differs from lightmap.h: glossy lobes send their energy
// out diffusely; all texels get the same number of rays; memory is 4 n bytes per texel. Limits: static
// surfaces.
#pragma once
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "relume/atlas/atlas.h"
#include "relume/atlas/texels.h"
#include "relume/core/progress.h"
#include "relume/scene/environment.h"
#include "relume/trace/tracer.h"
#include "relume/transport/emitters.h"
#include "relume/transport/reference.h"

namespace relume::transport {

struct SequenceOptions {
  std::uint32_t gather_samples = 256;  ///< n, rays of a texel; a power of two from bounce_samples to 65536
  std::uint32_t bounce_samples = 32;   ///< m, a power of two up to 64
  std::uint32_t light_samples = 8;     ///< shadow rays of a texel to lamps, and as many to the sun; likewise
  Materials materials = Materials::kFull;
  std::uint64_t seed = 1;
};

class LightSequence {
 public:
  /// Traces the rays. Keeps references. Throws Error kInterrupted.
  LightSequence(const trace::Tracer& tracer, const atlas::Atlas& atlas, const atlas::Texels& texels,
                const SequenceOptions& options, Progress& progress);
  ~LightSequence();

  /// Irradiance straight from emitters, on the fronts of all texels and on such backs as rays have met.
  /// Linear: sums and multiples are those of other lights.
  struct Direct {
    std::vector<Vec3> irradiance;  ///< fronts in the order of Texels::points, then backs
    void add(const Direct& other, Vec3 gain);
  };
  Direct dark() const;
  /// The environment is none of them; it is sampled where rays escape.
  Direct direct(const Emitters& emitters) const;

  /// Irradiance at texels that does not come straight from those emitters: reflected, and from the
  /// environment.
  struct Light {
    std::vector<Vec3> irradiance;  ///< in the order of Texels::points
    std::vector<float> error;      ///< estimated standard error of the luminance, by block of texels
  };
  Light light(const Direct& direct, const scene::Environment& environment) const;

  /// 0: buried in geometry.
  std::span<const std::uint8_t> valid() const;
  std::span<const float> backShare() const;
  std::uint64_t rays() const;  ///< traced so far

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace relume::transport
