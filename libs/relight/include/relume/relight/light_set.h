// SPDX-License-Identifier: MIT
// The JSON file that lists lights for the run-time (docs/command-line.md, LIGHTS.json).
#pragma once
#include <string>
#include <string_view>

#include "relume/core/light.h"

namespace relume::relight {

/// A list of lights: the fields of KHR_lights_punctual plus position, direction and, for area lights, area (m^2) and normal.
/// Throws Error kInvalidJson or kInvalidValue naming the light and the field.
LightSet parseLights(std::string_view json, const std::string& name);

}  // namespace relume::relight
