// SPDX-License-Identifier: MIT
// Relighting with obscurance: the ambient illumination model with light sources.
// Based on:
//   [IKSZ03] Iones, Krupkin, Sbert, Zhukov. Fast, Realistic Lighting for Video Games. 2003. Section 4.3, eqs
//   (5)-(7).
#pragma once
#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "relume/asset/asset.h"
#include "relume/relight/light_set.h"
#include "relume/relight/visibility.h"

namespace relume::relight {

struct LightSums;  // src/light_kernel.h
struct PreparedLight;

struct ObscuranceOptions {
  Irradiance ambient;  ///< I_A, as an irradiance
  float beta = 0.1f;   ///< share of every light that reaches every point as indirect light, in (0, 1)
};

/// Evaluates E(P) = (I_A + I'_S(P)) W(P) + I_S(P) at the covered texels of an asset, i.e. equation (5) before
/// the surface's own reflectances: I = k E with k_A = k_D = k.
///   I_S  = sum over lights of visibility * directIrradiance            (eq 6)
///   I'_S = beta * sum over all lights of incidentIrradiance            (eq 7; a directional light counts
///   with its lux)
/// The whole sum is formed anew each time: at some 10^9 texel-lights a second a hundred lights on 100,000
/// texels take milliseconds, and the result depends on the lights alone, not on what was shown before.
class ObscuranceRelighter {
 public:
  /// Copies what it needs out of the asset. Throws Error kMismatch unless `layer` has a plane "value" of 1
  /// channel (obscurance) or 3 (spectral) over the asset's pages.
  ObscuranceRelighter(const asset::Asset& asset, const asset::Layer& layer);
  ~ObscuranceRelighter();
  ObscuranceRelighter(ObscuranceRelighter&&) noexcept;

  std::size_t texelCount() const { return result_.size(); }

  /// shape: [texels of the atlas table]; valid until the next call. Lights must be finite, their directions
  /// of unit length (parseLights sees to it). Nearer than a micrometre to a light its irradiance is taken as
  /// 0. `visibility` is asked about the texels of the atlas table. Allocates nothing after the first call
  /// with as many lights, and throws only what `visibility` throws.
  std::span<const Irradiance> evaluate(const LightSet& lights, const ObscuranceOptions& options,
                                       const VisibilitySource& visibility = {});

 private:
  std::array<std::vector<float>, 3> position_, normal_,
      w_;  ///< one array for each coordinate: vector loads need no shuffles
  std::vector<Irradiance> result_;
  std::vector<float> visibility_;
  std::vector<PreparedLight> prepared_;
  std::vector<LightSums> sums_;

  void addLights(std::size_t begin, std::size_t first, std::size_t last, bool use_visibility,
                 LightSums& sums) const;
  void finish(std::size_t begin, const LightSums& sums, const ObscuranceOptions& options);
};

}  // namespace relume::relight
