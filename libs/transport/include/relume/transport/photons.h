// SPDX-License-Identifier: MIT
// Light tracing: paths shot from all that shines, in proportion to power, deposit their flux in the texels
// where they land. Based on:
//   [HP02] Hey, Purgathofer. Real-Time Rendering of Globally Illuminated Soft Glossy Scenes With Directional
//   Light Maps. 2002. Section 3.1.
//   [Veach97] Veach. Robust Monte Carlo Methods for Light Transport Simulation. Thesis, 1997. Section 5.3:
//   what shading normals ask of light that is traced this way round.
//   [WHSG97] Walter, Hubbard, Shirley, Greenberg. Global Illumination Using Local Linear Density Estimation.
//   1997: density estimation on surfaces.
// Flux is counted in whole numbers of a unit, about 2^-20 of a path's: sums do not depend on their order, so
// bits do not depend on the number of threads, and the balance of flux is exact. What differs from [HP02]: a
// path deposits in the one texel where it lands; kernels then weigh texels, not paths, and divide by the area
// that they cover, so neither the rim of a chart nor a texel that it covers in part is too dark. Surfaces
// reflect with their full materials, as in reference.h; what is reflected is decided by the BSDF as seen
// from where the path goes to, because it is not reciprocal. Limits: static surfaces only; light that passes
// thin transmission is not tinted; a texel holds its irradiance over all of its footprint.
#pragma once
#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "relume/atlas/atlas.h"
#include "relume/atlas/texels.h"
#include "relume/basis/basis.h"
#include "relume/core/progress.h"
#include "relume/core/quantity.h"
#include "relume/trace/tracer.h"
#include "relume/transport/reference.h"

namespace relume::transport {

struct PhotonKernel {
  enum class Shape : std::uint8_t {
    kBox,       ///< each texel for itself: no blur, most noise
    kPyramid,   ///< [HP02]: linear fall-off both ways, `width` texels from rim to rim
    kAdaptive,  ///< a pyramid as wide as it takes to hold `paths` of them, up to 17 texels
  };
  Shape shape = Shape::kPyramid;
  float width = 1.5f;  ///< texels, 1 to 17
  std::uint32_t paths = 64;
};

struct PhotonOptions {
  std::uint64_t paths = 1u << 20;
  Part part = Part::kTotal;
  Materials materials = Materials::kFull;
  int max_bounces = ReferenceOptions::kUnlimited;  ///< as in ReferenceOptions
  PhotonKernel kernel;
  std::uint64_t seed = 1;
  std::shared_ptr<const basis::Basis> receiver;  ///< as in LightmapOptions
};

/// Where all flux has gone, RGB, in units of `unit`. What is shot or reflected either lands, escapes, or
/// fades:
///   shot + reflected = landed + escaped + faded.
/// What lands on fronts of texels is deposited in them (but for the part that is not asked for).
struct PhotonBalance {
  using Flux = std::array<std::int64_t, 3>;
  Flux shot{}, reflected{}, landed{}, escaped{};
  Flux faded{};      ///< lost where lamps end before their range
  Flux deposited{};  ///< sum over texels
  Flux elsewhere{};  ///< of landed: on backs, where there is no texel, or of the other part
  double unit = 0;   ///< W
};

struct PhotonResult {
  std::vector<Irradiance> value;   ///< by point of Texels
  std::vector<float> error;        ///< standard error of the luminance
  std::vector<float> sums;         ///< shape [points][receiver->sums()]
  std::vector<std::int64_t> flux;  ///< what each texel was given, before kernels: shape [points][3], units
  PhotonBalance balance;
  std::uint64_t rays = 0;
};

/// Throws Error kInterrupted when `progress` is cancelled; advances it by the paths.
PhotonResult tracePhotons(const trace::Tracer& tracer, const atlas::Atlas& atlas, const atlas::Texels& texels,
                          const PhotonOptions& options, Progress& progress);

}  // namespace relume::transport
