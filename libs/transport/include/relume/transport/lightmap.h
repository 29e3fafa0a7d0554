// SPDX-License-Identifier: MIT
// Irradiance at texels from the scene's own lights, direct and over any number of bounces: a lightmap. Based
// on:
//   [RTR] Akenine-Moeller, Haines, Hoffman. Real-Time Rendering, 3rd ed. Sections 11.1, 11.2, 11.5.1.
//   [Veach97] Veach. Robust Monte Carlo Methods for Light Transport Simulation. Thesis, 1997. Section 9.2.4.
// Light that has bounced is gathered by cosine-weighted rays, each of which ends in one look-up of what the
// surface there sends out (radiance cache: all bounces, found once for the whole atlas). Direct light is
// sampled at the emitters; what gather rays meet of them by chance is combined with that. What holds: the
// conventions of reference.h; values are means over a texel's footprint, or, where other bodies stand in it,
// over the largest part that can be seen. With Materials::kFull and any number of bounces, rays that end on
// glossy surfaces go on by chance as the lobes mirror them. What differs from the reference: what surfaces
// send out diffusely is the mean over a texel, the diffuse lobe under its coat the mean over outgoing
// directions; with a number of bounces, and in kRadiosity, glossy lobes send their energy out diffusely too.
// Limits: static surfaces only; light that passes thin transmission is not tinted.
#pragma once
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "relume/atlas/atlas.h"
#include "relume/atlas/texels.h"
#include "relume/basis/basis.h"
#include "relume/core/progress.h"
#include "relume/core/quantity.h"
#include "relume/trace/tracer.h"
#include "relume/transport/radiosity.h"
#include "relume/transport/reference.h"

namespace relume::transport {

enum class LightmapMethod : std::uint8_t {
  kGather,     ///< as said above
  kRadiosity,  ///< the same, but what surfaces send out comes from patches (radiosity.h)
  kPath,       ///< random walks for every texel: unbiased, a hundred times slower; samples are paths
};

struct LightmapOptions {
  LightmapMethod method = LightmapMethod::kGather;
  Part part = Part::kTotal;
  Materials materials = Materials::kFull;
  int max_bounces = ReferenceOptions::kUnlimited;     ///< as in ReferenceOptions
  std::uint32_t min_samples = 64, max_samples = 256;  ///< gather rays per texel, powers of two up to 65536
  /// A texel stops when its estimated standard error is below this share of the mean irradiance of the scene,
  /// of less than that where it is darker (down to a quarter); 0: always max_samples. With `smoothed`, the
  /// error that smoothing leaves.
  float target_error = 0.0f;
  bool smoothed = false;             ///< as in OcclusionOptions
  std::uint32_t cache_samples = 16;  ///< rays per texel that light is handed on along, a power of two
  std::uint64_t seed = 1;
  RadiosityOptions radiosity;  ///< for kRadiosity
  std::string group;           ///< of scene::lightGroups that shines alone; empty: all; kGather and kPath
  /// Also what arrives from where, as this basis sums it up; null: irradiance alone; kGather and kRadiosity.
  std::shared_ptr<const basis::Basis> receiver;
};

/// Per texel, in the order of Texels::points.
struct LightmapResult {
  std::vector<Irradiance> value;
  std::vector<float> error;       ///< estimated standard error of the luminance
  std::vector<float> back_share;  ///< of gather rays that met a back face: near 1 inside geometry; 1 where
                                  ///< nothing can be seen
  std::vector<float> sums;  ///< shape [][receiver->sums()], at receivers with the texels' shading normals
  std::uint64_t rays = 0;
};

/// Solves for texels. Keeps references. Bits do not depend on the number of threads, nor on which other
/// texels are in a selection.
class LightmapSolver {
 public:
  LightmapSolver(const trace::Tracer& tracer, const atlas::Atlas& atlas, const atlas::Texels& texels,
                 const LightmapOptions& options);
  ~LightmapSolver();
  LightmapSolver(LightmapSolver&&) noexcept;

  /// As OcclusionSolver::solve. The first call fills the cache.
  LightmapResult solve(Progress& progress, std::span<const std::uint32_t> which = {});

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace relume::transport
