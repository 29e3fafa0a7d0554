// SPDX-License-Identifier: MIT
// Lights as shaders read them (shaders/lights.glsl).
#pragma once
#include "relume/core/light.h"

namespace relume::render {

struct GpuLight {
  Vec4 position_kind, direction_back, strength_area, cone, shadow_origin;
};

/// `shadow_layer`: of the cube or plane maps, which was drawn from `shadow_origin`; negative: the light is
/// seen everywhere.
GpuLight toGpu(const Light& light, int shadow_layer, Point shadow_origin);

/// Same but for colour and intensity: what it shines on and its shadows stay.
bool sameButStrength(const Light& a, const Light& b);

}  // namespace relume::render
