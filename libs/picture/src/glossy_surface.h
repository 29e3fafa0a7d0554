// SPDX-License-Identifier: MIT
// What a surface of a scene shows of directional light: diffuse with its normal map, and gloss.
#pragma once
#include "relume/basis/basis.h"
#include "relume/picture/picture.h"
#include "relume/scene/scene.h"

namespace relume::picture {

/// Radiance that is reflected `to_viewer` (without emission), of light that `basis` knows by `coefficients`
/// at a surface whose own normal is `at`. As the path tracer has it: a metallic lobe with the base colour, a
/// dielectric one with F0 = 0.04 over a diffuse rest; Phong's lobes instead of GGX with the exponent
/// 1 / (2 alpha^2), as wide a highlight.
Vec3 reflectedLight(const basis::Basis& basis, const basis::Receiver& at, std::span<const float> coefficients,
                    const scene::Surface& surface, Normal normal, Direction to_viewer, Gloss gloss);

}  // namespace relume::picture
