// SPDX-License-Identifier: MIT
// Visibility and distance-weighted visibility at texels, by cosine-weighted low-discrepancy rays.
// Based on:
//   [RTR] Akenine-Moeller, Haines, Hoffman. Real-Time Rendering, 3rd ed. Section 11.3: k_A (11.8), bent
//   normal (11.10). [IKSZ03] Iones et al. Fast, Realistic Lighting for Video Games: W (3), rho (2) and (8).
//   [USKP09] Umenhoffer et al. Multi-scale precomputed radiance transfer, section 8: spectral obscurance.
#pragma once
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "relume/atlas/texels.h"
#include "relume/core/progress.h"
#include "relume/core/quantity.h"
#include "relume/trace/tracer.h"

namespace relume::transport {

/// The distance weight rho(L) of obscurance: 0 at L = 0, increasing, concave, 1 beyond the limit and where
/// nothing is hit.
struct DistanceWeight {
  enum class Shape : std::uint8_t {
    kExponential,     ///< 1 - exp(-L/tau) ([IKSZ03] 2); with a finite limit normalised to reach 1 there:
                      ///< (1-e^{-L/tau})/(1-e^{-limit/tau})
    kExponentialCut,  ///< 1 - exp(-L/tau) below the limit, 1 beyond it (a jump)
    kLinear,          ///< L / limit
    kSqrt,            ///< sqrt(L / limit)
    kStep,            ///< 0 below the limit: distance-limited ambient occlusion
  };
  Shape shape = Shape::kStep;
  float tau = 1.0f;         ///< metres
  float limit = kInfinity;  ///< metres: rays stop here

  float operator()(float distance) const;
};

/// A texel of which more rays than this share meet the back of a face lies, in part at least, inside
/// geometry. What the buried part does not see would darken the part that shows: a row of dark dots where
/// bodies meet.
inline constexpr float kBuriedShare = 0.25f;

enum class OcclusionKind : std::uint8_t { kScalar, kSpectral };

struct OcclusionOptions {
  OcclusionKind kind = OcclusionKind::kScalar;
  DistanceWeight weight;
  bool bent_normal =
      false;           ///< also the cosine-weighted bent normal of the open directions (hits count by weight)
  Albedo mean_albedo;  ///< a~ of [USKP09] section 8 (spectral only)
  std::uint32_t min_samples = 64, max_samples = 256;  ///< rays per texel, powers of two up to 65536
  /// A texel stops when its estimated standard error is below this; 0: always max_samples. With `smoothed`
  /// the error that is left after smoothing, as far as the number of the chart's texels in the block tells.
  float target_error = 0.0f;
  /// The values will be smoothed over blocks of 4 x 4 texels (filterTexels): the rounds of a block are then
  /// nets of 16 times as many samples. Otherwise each texel has the best samples for itself.
  bool smoothed = false;
  std::uint64_t seed = 1;
};

/// Per texel, in the order of Texels::points.
struct OcclusionResult {
  std::vector<Vec3> value;  ///< k_A or W; grey for scalar kinds (all three equal). Spectral W may exceed 1
  std::vector<Direction>
      bent;  ///< unit, world; the shading normal where nothing is open. Empty unless asked for
  std::vector<float> error;  ///< estimated standard error of the value's mean channel
  /// Share of rays (those within the limit) that met a back face: a texel inside geometry is near 1. For
  /// kStep, whose rays do not look for the first hit, estimated from a few, and 0 where less than a quarter
  /// of the rays are blocked.
  std::vector<float> back_share;
  std::uint64_t rays = 0;
};

/// Solves for texels. Keeps references to the tracer and the texels. Bits do not depend on the number of
/// threads, nor on which other texels are in the selection: random numbers are a function of (seed, texel).
class OcclusionSolver {
 public:
  OcclusionSolver(const trace::Tracer& tracer, const atlas::Texels& texels, const OcclusionOptions& options);
  ~OcclusionSolver();
  OcclusionSolver(OcclusionSolver&&) noexcept;

  /// `which`: indices into texels.points; empty means all (results then cover all points; otherwise `which`
  /// only). Work is done by blocks of 4 x 4 texels, so a selection costs as much as the blocks that it
  /// touches. Advances `progress` by one for every result; throws Error kInterrupted. Not from two threads at
  /// once.
  OcclusionResult solve(Progress& progress, std::span<const std::uint32_t> which = {});

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// One solve with a solver of its own.
OcclusionResult solveOcclusion(const trace::Tracer& tracer, const atlas::Texels& texels,
                               const OcclusionOptions& options, Progress& progress,
                               std::span<const std::uint32_t> which = {});

/// Area-weighted mean of the diffuse albedo over the texels: the a~ of [USKP09].
Albedo meanAlbedo(const atlas::Texels& texels);

// Interreflection corrections of occlusion ([RTR] 11.3.3); k in [0, 1], rho the albedo.
float correctedStewartLanger(float k, float rho);  ///< k / (1 - rho (1 - k))  ([RTR] 11.13)
float correctedJimenez(float k, float rho);        ///< cubic fit of multi-bounce AO (Jimenez et al. 2016)

/// Edge-aware smoothing in texel space that never crosses charts or creases. `values`: [points][channels], in
/// place. `error`: the standard error of each point's values; `error_left`, where given, becomes that of the
/// smoothed values, were the errors of neighbours independent (it must not be `error`).
struct FilterOptions {
  int radius = 2;  ///< texels, smaller than the gutter plus the chart
  int normal_power = 32;
  float error_scale = 5.0f;  ///< values further apart than this many standard errors are not mixed
  int guides = 0;            ///< so many of the first channels say how far apart; 0: all
};
void filterTexels(const atlas::Texels& texels, std::span<const float> error,
                  std::span<const std::uint8_t> valid, int channels, std::span<float> values,
                  std::span<float> error_left = {}, const FilterOptions& options = {});

}  // namespace relume::transport
