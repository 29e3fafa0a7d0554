// SPDX-License-Identifier: MIT
// The lights that a command works with: a LIGHTS.json, or the scene's own.
#pragma once
#include <string>

#include "relume/core/light.h"
#include "relume/scene/scene.h"

namespace relume::app {

/// Lights of `file`, or of the scene when it is empty.
LightSet chooseLights(const std::string& file, const scene::Scene& scene);

}  // namespace relume::app
