// SPDX-License-Identifier: MIT
// What the bases with one light and a rest share: which way most light comes from.
#pragma once
#include <span>

#include "bases/triples.h"
#include "relume/basis/sh.h"

namespace relume::basis {

/// Along the mean of directions, weighted by luminance: "optimal linear direction" ([Slo08]). `sh`: radiance,
/// RGB, bands 0 and 1 at least; `otherwise` where there is none.
struct LightDirection {
  Direction direction{0, 0, 1};
  float share = 0;  ///< of light that agrees: 1 from one direction, 0 from all around, 1/2 from a hemisphere
};
/// A basis with one light says nothing of its size; gloss takes it for a Gaussian of this sharpness, 15
/// degrees or so. As a point it leaves highlights as bright as a lamp's.
inline constexpr float kLightSharpness = 12.0f;

inline LightDirection lightDirection(std::span<const float> sh, Direction otherwise) {
  const Vec3 linear(luminance(triple(sh, 3)), luminance(triple(sh, 1)), luminance(triple(sh, 2)));
  const float length = glm::length(linear), all = luminance(triple(sh, 0));
  if (!(length > 1e-6f * all)) return {otherwise, 0.0f};
  return {linear / length, std::min(length / (1.7320508f * all), 1.0f)};
}

}  // namespace relume::basis
