// SPDX-License-Identifier: MIT
#include "lights.h"

#include "relume/core/file.h"
#include "relume/relight/light_set.h"

namespace relume::app {

LightSet chooseLights(const std::string& file, const scene::Scene& scene) {
  return file.empty() ? scene.lights : relight::parseLights(readTextFile(file), file);
}

}  // namespace relume::app
