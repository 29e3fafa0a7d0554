// SPDX-License-Identifier: MIT
// The JSON file that lists lights for the run-time (docs/command-line.md, LIGHTS.json).
#pragma once
#include <string>
#include <string_view>

#include "relume/core/light.h"

namespace relume::relight {

/// A list of lights, or an object whose member `lights` is one. Fields are those of KHR_lights_punctual: type
/// (point, spot, directional; here also area), color, intensity, range, spot {innerConeAngle,
/// outerConeAngle}, name; and, as there is no node: position (all but directional), direction (spot,
/// directional: the way the light travels), and for area lights area (m^2) and normal; intensity of an area
/// light is its radiance. Vectors need not have unit length. Defaults as in KHR_lights_punctual. Strict:
/// throws Error kInvalidJson or kInvalidValue naming the light and the field, also for a field that is not
/// known.
LightSet parseLights(std::string_view json, const std::string& name);

}  // namespace relume::relight
