// SPDX-License-Identifier: MIT
// The lights that a command works with: a LIGHTS.json, or the scene's own; and the environment.
#pragma once
#include <string>

#include "relume/core/light.h"
#include "relume/scene/scene.h"

namespace relume::app {

/// Lights of `file`, or of the scene when it is empty.
LightSet chooseLights(const std::string& file, const scene::Scene& scene);

/// The environment of the light file, its image read from beside it; a dark one where there is none. Throws
/// Error.
scene::Environment chooseEnvironment(const std::string& file);

}  // namespace relume::app
