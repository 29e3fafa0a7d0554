// SPDX-License-Identifier: MIT
// Planes of a bake as textures.
#pragma once
#include <span>

#include "gl_objects.h"
#include "relume/asset/asset.h"

namespace relume::render {

/// Bilinear. 1 channel reads as grey.
Texture planeTexture(const asset::AtlasTable& atlas, const asset::Plane& plane);
/// Half floats, by texel of the table; alpha 0 where the table has none.
Texture labelTexture(const asset::AtlasTable& atlas, std::span<const Vec3> colours);
/// One white texel, for what is not there.
Texture whiteArray();

}  // namespace relume::render
