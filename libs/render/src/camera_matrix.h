// SPDX-License-Identifier: MIT
#pragma once
#include "relume/render/renderer.h"

namespace relume::render {

/// Clip from world, depth from 1 at the near plane to 0 at infinity (orthographic: at the far end of
/// `scene`): float depth has its digits where distances are large. `offset`: of the picture, in clip space.
Mat4 clipFromWorld(const Camera& camera, const Box3& scene, float aspect, Vec2 offset);

}  // namespace relume::render
