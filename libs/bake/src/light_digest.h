// SPDX-License-Identifier: MIT
// The digest of what shines in a scene, for layers that are lit by it.
#pragma once
#include "relume/core/hash.h"
#include "relume/scene/scene.h"

namespace relume::bake {

/// Lights, the environment, and the normal maps that turn what they throw.
void addLightsAndNormals(Hasher& hasher, const scene::Scene& scene);

}  // namespace relume::bake
