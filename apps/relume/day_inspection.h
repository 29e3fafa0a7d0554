// SPDX-License-Identifier: MIT
// What `relume inspect` tells of a baked day: its keyframes, and how few images make them.
#pragma once
#include <filesystem>
#include <nlohmann/json.hpp>

#include "relume/asset/day_frames.h"

namespace relume::app {

/// {"keyframes": [{"minutes", "time"}...], "components", "variance": [share held by 1, 2... components], ...}
nlohmann::ordered_json describeDay(const asset::DayFrames& frames);

/// Keyframes by the hour, with the shortest interval of each.
void printDay(const asset::DayFrames& frames);

/// day-intervals.svg: minutes between keyframes through the day; day-spectrum.svg: variance that components
/// leave. `name` stands for "day" where it is another layer's.
void plotDay(const asset::DayFrames& frames, const std::string& name, const std::filesystem::path& folder);

}  // namespace relume::app
