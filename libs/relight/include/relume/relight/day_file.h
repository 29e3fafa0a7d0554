// SPDX-License-Identifier: MIT
// The JSON file of a day (docs/command-line.md, DAY.json).
#pragma once
#include <string>
#include <string_view>

#include "relume/core/day.h"

namespace relume::relight {

/// An object; every member may be missing: latitude, longitude (degrees), date ("2011-06-21"), utcOffset
/// (hours), heading (degrees from north to which -Z looks), turbidity, scale, sun (true or false), sky
/// ("model", "constant", "none"), begin, end ("HH:MM"), groups {name: [["HH:MM", gain or [r, g, b]], ...]},
/// lights: those of LIGHTS.json, each of which may have keys [{time, intensity, color, position, direction},
/// ...]. Strict: throws Error kInvalidJson or kInvalidValue naming the member, also for one that is not
/// known.
Day parseDay(std::string_view json, const std::string& name);

}  // namespace relume::relight
