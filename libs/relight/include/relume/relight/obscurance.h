// SPDX-License-Identifier: MIT
// Relighting with obscurance: the ambient illumination model with light sources.
// Based on:
//   [IKSZ03] Iones, Krupkin, Sbert, Zhukov. Fast, Realistic Lighting for Video Games. 2003. Section 4.3, eqs (5)-(7).
#pragma once
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "relume/asset/asset.h"
#include "relume/relight/light_set.h"

namespace relume::relight {

struct ObscuranceOptions {
  Irradiance ambient;      ///< I_A, as an irradiance
  float beta = 0.1f;       ///< share of every light that reaches every point as indirect light, in (0, 1)
};

/// Visibility of `light` (its index in the set) at points [begin, end): fills with values in [0, 1]. The run-time has no rays; an
/// engine answers from its shadow maps, the command line from rays. None: every light is seen everywhere.
using VisibilitySource = std::function<void(std::size_t light, std::span<float> visibility)>;

/// Evaluates E(P) = (I_A + I'_S(P)) W(P) + I_S(P) at the covered texels of an asset, i.e. equation (5) before the surface's own
/// reflectances: I = k E with k_A = k_D = k. Contributions of lights are kept, so that changing one costs one light.
class ObscuranceRelighter {
 public:
  /// `w`: [texels of the atlas table] or x3 for spectral, taken from the layer. Keeps references to the asset.
  ObscuranceRelighter(const asset::Asset& asset, const asset::Layer& layer);

  /// shape: [texels of the atlas table]. Does not allocate after the first call with as many lights.
  std::span<const Irradiance> evaluate(const LightSet& lights, const ObscuranceOptions& options,
                                       const VisibilitySource& visibility = {});

 private:
  const asset::Asset& asset_;
  std::vector<Vec3> w_;
  std::vector<Irradiance> result_;
  std::vector<float> visibility_;
};

}  // namespace relume::relight
