// SPDX-License-Identifier: MIT
#include "lights.h"

#include <filesystem>

#include "relume/core/error.h"
#include "relume/core/file.h"
#include "relume/image/io.h"
#include "relume/relight/light_set.h"
#include "relume/scene/sky.h"

namespace relume::app {

LightSet chooseLights(const std::string& file, const scene::Scene& scene) {
  return file.empty() ? scene.lights : relight::parseLights(readTextFile(file), file);
}

scene::Environment chooseEnvironment(const std::string& file) {
  scene::Environment environment;
  if (file.empty()) return environment;
  const auto source = relight::parseEnvironment(readTextFile(file), file);
  if (!source) return environment;
  environment.radiance = Radiance(source->radiance);
  environment.rotation = source->rotation;
  if (source->sky) {
    environment.map = std::make_shared<const image::Image>(
        scene::skyImage(-source->sky->sun_direction, source->sky->turbidity));
  } else if (!source->file.empty()) {
    const auto path = std::filesystem::path(file).parent_path() / source->file;
    image::Image map = image::readImage(path);
    if (map.channels < 3)
      throw Error(ErrorCode::kUnsupported, path.string(), "has no colours",
                  "an environment needs three channels");
    for (const float x : map.data)
      if (!(x >= 0 && x < kInfinity))
        throw Error(ErrorCode::kInvalidValue, path.string(), "has pixels that are negative or not finite");
    environment.map = std::make_shared<const image::Image>(std::move(map));
  }
  return environment;
}

}  // namespace relume::app
