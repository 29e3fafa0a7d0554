// SPDX-License-Identifier: MIT
// Direct light on all texels, with few samples each: for means over patches.
#pragma once
#include <cstdint>
#include <vector>

#include "radiosity/radiosity.h"

namespace relume::transport {

struct TexelLight {
  std::vector<Vec3> irradiance;   ///< E, by point
  std::vector<float> back_share;  ///< of gather rays that met the back of a surface, by point
  std::uint64_t rays = 0;
};

/// By sampling the emitters and by rays that meet them, combined. Throws Error kInterrupted.
TexelLight texelLight(const RadiosityScene& scene, const Emitters& emitters, std::uint64_t seed,
                      Progress& progress);

}  // namespace relume::transport
