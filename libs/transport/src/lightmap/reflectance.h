// SPDX-License-Identifier: MIT
// What share of the light that falls on a texel leaves it again.
#pragma once
#include <vector>

#include "relume/atlas/texels.h"
#include "relume/transport/reference.h"

namespace relume::transport {

/// By point: reflectance in [0, 1]. kLambert: the diffuse albedo. kFull: also what glossy lobes reflect, as
/// if it left in all directions alike (the directional-hemispherical reflectance of bsdf.h, averaged over
/// cosine- weighted directions): energy is right, its direction is not.
std::vector<Vec3> reflectances(const scene::Scene& scene, const atlas::Texels& texels, Materials materials);

}  // namespace relume::transport
