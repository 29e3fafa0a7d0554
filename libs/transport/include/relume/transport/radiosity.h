// SPDX-License-Identifier: MIT
// Classical radiosity as a source of reflected light for lightmaps (docs/radiosity.md): patches, their form
// factors, and the solution of their equations. Based on:
//   [RTR] Akenine-Moeller, Haines, Hoffman. Real-Time Rendering, 3rd ed. Section 11.2.1,
//   equations 11.4, 11.5. [CG85] Cohen, Greenberg. The Hemi-Cube: A Radiosity Solution for Complex
//   Environments. SIGGRAPH 1985. [CCWG88] Cohen, Chen, Wallace, Greenberg. A Progressive Refinement Approach
//   to Fast Radiosity Image Generation. SIGGRAPH 1988.
// Differs from them: direct light is not taken from patches, and a texel gathers the light of patches by rays
// (one last bounce), so patches are seen by nobody. Limits: patches are the fronts of surfaces, light that
// falls on backs is lost; memory grows with patches times the patches that each of them sees.
#pragma once
#include <cstdint>

namespace relume::transport {

struct RadiosityOptions {
  enum class FormFactors : std::uint8_t {
    kSampled,   ///< cosine-weighted rays from all over a patch
    kHemicube,  ///< the view from its middle
  };
  enum class Solution : std::uint8_t { kGathering, kProgressive };
  /// How emissive surfaces light patches; other emitters are always sampled.
  enum class Emission : std::uint8_t {
    kSampled,  ///< as other emitters, from every texel
    kPatches,  ///< as patches that emit, by form factors: small lamps are found by few rays
  };

  std::uint32_t patch = 4;  ///< texels along a side, 1 to 64
  FormFactors form_factors = FormFactors::kSampled;
  Solution solution = Solution::kGathering;
  Emission emission = Emission::kSampled;
  std::uint32_t rays = 256;            ///< of a patch, for sampled form factors
  std::uint32_t cube_resolution = 32;  ///< pixels along a hemicube's top, a multiple of 8
  double residual = 1e-5;  ///< of the equations, relative to all light: where their solution stops
};

}  // namespace relume::transport
