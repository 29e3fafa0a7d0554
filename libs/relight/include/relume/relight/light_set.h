// SPDX-License-Identifier: MIT
// The JSON file that lists lights for the run-time (docs/command-line.md, LIGHTS.json).
#pragma once
#include <optional>
#include <string>
#include <string_view>

#include "relume/core/light.h"

namespace relume::relight {

/// A list of lights, or an object whose member `lights` is one (it may have an `environment` alone). Fields
/// are those of KHR_lights_punctual: type (point, spot, directional; here also area), color, intensity,
/// range, spot {innerConeAngle, outerConeAngle}, name, and group; and, as there is no node: position (all but
/// directional), direction (spot, directional: the way the light travels), and for area lights either
/// area (m^2), position and normal of a disk, or vertices, the corners of a flat polygon that shines to the
/// side from which they go counter-clockwise; both may be twoSided; intensity of an area light is its
/// radiance. A directional light may have an angularDiameter in
/// radians (the sun: 0.0093): what casts shadows then sees a disk of that size. Vectors need not have unit
/// length. Defaults as in KHR_lights_punctual. Strict: throws Error kInvalidJson or kInvalidValue naming the
/// light and the field, also for a field that is not known.
LightSet parseLights(std::string_view json, const std::string& name);

/// What a light file says of the light that comes from all around.
struct EnvironmentSource {
  Vec3 radiance{1.0f};    ///< of every direction; beside a file or a sky a factor
  std::string file;       ///< equirectangular image, relative to the light file; empty: none
  float rotation = 0.0f;  ///< radians, counter-clockwise about +y seen from above
  struct Sky {
    Direction sun_direction{0, -1, 0};  ///< the way sunlight travels, as of a directional light
    float turbidity = 3.0f;
  };
  std::optional<Sky> sky;  ///< a clear sky instead of a file
};
/// The member `environment` of a light file that is an object: {radiance, file, rotation} or {radiance, sky
/// {direction, turbidity}, rotation}. Nothing where the file has none. Throws as parseLights.
std::optional<EnvironmentSource> parseEnvironment(std::string_view json, const std::string& name);

}  // namespace relume::relight
