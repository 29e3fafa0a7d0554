// SPDX-License-Identifier: MIT
// What a height map tells of the small scale: normals, cones of free sight, and how much light the relief
// leaves its own points. Heights are shares of `depth`, 1 on top; maps repeat.
// Based on:
//   [LPM] Umenhoffer, Szirmay-Kalos, Szecsi, Toth. Global Illumination in Games with Multi-scale PRT, section
//   9.
//   [PO07] Policarpo, Oliveira. Relaxed Cone Stepping for Relief Mapping. GPU Gems 3, ch. 18. 2007.
// Differs from [LPM], whose text calls the top h = 0 where its formulas have h = 1, and whose gamma has to be
// the closed angle, pi less the aperture of the cone, for its own formula to close as the cone does.
#pragma once
#include "relume/image/image.h"

namespace relume::image {

struct ReliefOptions {
  float depth = 0.05f;  ///< from top to bottom, as a share of the width of the map
};

/// W(alpha, gamma, h) = (1 + h cos alpha + (1 - h) cos gamma) / 2 ([LPM] 9): the open share of the cosine
/// weighted hemisphere at height h, the normal turned by alpha, in a wedge whose closed angle is gamma.
float smallScaleOcclusion(float cos_alpha, float cos_gamma, float h);

/// Unit normals in tangent space (x along u, y to the top of the map, z up), central differences.
/// `heights`: 1 channel.
Image reliefNormals(const Image& heights, const ReliefOptions& options = {});
/// Sine of half the aperture of the widest upright cone over each texel that holds no other texel ([PO07],
/// the strict form), 1 channel; steeper than kWidestCone is not asked for, since nothing so flat hides light.
Image reliefCones(const Image& heights, const ReliefOptions& options = {});
inline constexpr float kWidestCone = 4.0f;  ///< tangent of half the aperture

/// W at each texel, from its normal and its cone. 1 channel.
Image reliefOcclusion(const Image& heights, const Image& normals, const Image& cones);

}  // namespace relume::image
