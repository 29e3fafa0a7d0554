// SPDX-License-Identifier: MIT
// One light on a block of texels: the inner loop of relighting. Same physics as core/light.h, arranged for
// vector units: what depends on the light alone is computed once, no square root but one, no branch.
#pragma once
#include <array>
#include <cstddef>

#include "relume/core/light.h"

namespace relume::relight {

inline constexpr std::size_t kBlock = 256;  ///< texels; a block's arrays stay in the first-level cache

/// What of a light does not depend on the texel.
struct PreparedLight {
  explicit PreparedLight(const Light& light);

  Light::Kind kind;
  Vec3 strength;  ///< colour * intensity
  Point position;
  Direction direction;
  float inverse_range2;  ///< 0: unlimited
  float cos_outer, inverse_cone;
  float area;
  float back;  ///< of an area light: 1 where it shines to both sides, else 0
};

/// Texels [0, count) of a block, count <= kBlock.
struct TexelBlock {
  std::array<const float*, 3> position, normal;
  const float* visibility;  ///< null: all 1
  std::size_t count;
};

/// Sums over lights, RGB.
struct LightSums {
  alignas(64) float direct[3][kBlock];    ///< visibility * E * cos
  alignas(64) float incident[3][kBlock];  ///< E on a plane that faces the light
};

/// received: [count], visibility * E * cos of a light of unit strength
void receivedFactors(const PreparedLight& light, const TexelBlock& texels, float* received);
void addLight(const PreparedLight& light, const TexelBlock& texels, LightSums& sums);

}  // namespace relume::relight
