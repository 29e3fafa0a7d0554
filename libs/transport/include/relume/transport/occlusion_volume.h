// SPDX-License-Identifier: MIT
// How much of the light about it an object hides, on a grid around it, so that it darkens surfaces it comes
// near to without being baked. Based on:
//   [MMAH07] Malmer, Malmer, Assarsson, Holzschuch. Fast Precomputed Ambient Occlusion for Proximity Shadows.
//   2007. Differs: each cell knows the mean hidden direction too and hides as a cap of directions of that
//   size about it would, which is exact for a ball.
#pragma once
#include <cstdint>
#include <vector>

#include "relume/trace/tracer.h"

namespace relume::transport {

struct OcclusionVolume {
  Box3 box;      ///< in the frame of the rays
  int side = 0;  ///< cells along each axis; their middles are where values hold
  /// shape: [z][y][x]; xyz: unit, mean of the hidden directions (0 where nothing is hidden); w: the hidden
  /// share of all directions
  std::vector<Vec4> cells;
};

struct OcclusionVolumeOptions {
  int side = 16;
  float reach = 1.0f;  ///< how far it extends about the object, in its largest extents
  std::uint32_t rays = 256;
};

/// Of all that the tracer meets, over `object`, its box.
OcclusionVolume occlusionVolume(const trace::Tracer& tracer, const Box3& object,
                                const OcclusionVolumeOptions& options = {});

/// Share of the cosine-weighted hemisphere about a normal that a cap of directions hides: `share` of the
/// sphere about a direction at `cosine` to the normal. Closed form for caps that the horizon cuts too.
float hiddenByCap(float share, float cosine);

}  // namespace relume::transport
