// SPDX-License-Identifier: MIT
// Things that are put into a baked scene: --object.
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "relume/render/renderer.h"
#include "relume/scene/scene.h"

namespace relume::app {

/// Instances of a scene that move together.
using Group = std::vector<std::uint32_t>;

/// Adds "FILE.glb@x,y,z[,turn[,scale]]": its origin at that place (metres), turned by degrees about +y.
/// Throws Error kUsage, and what opening files throws.
Group addObject(scene::Scene& scene, const std::string& text);

/// What a renderer is told of groups: with what each hides of the light about it.
render::Object objectOf(const scene::Scene& scene, const Group& group);

}  // namespace relume::app
