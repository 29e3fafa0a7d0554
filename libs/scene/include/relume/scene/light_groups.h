// SPDX-License-Identifier: MIT
// What shines together: lamps that are dimmed, coloured and switched as one.
#pragma once
#include <string>
#include <vector>

#include "relume/scene/scene.h"

namespace relume::scene {

/// The group of the environment.
inline constexpr const char* kEnvironmentGroup = "environment";

/// Its extras.relume.group, or its own name, or "light" (a material: "material") where it has none.
std::string groupOf(const Light& light);
std::string groupOf(const Material& material);

/// The groups that send out any light: of lamps, of emissive materials on static instances, and of the
/// environment; each once, in that order.
std::vector<std::string> lightGroups(const Scene& scene);

}  // namespace relume::scene
