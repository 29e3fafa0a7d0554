// SPDX-License-Identifier: MIT
// The rows of irradiance from the scene's own lights.
#pragma once
#include "relume/bake/registry.h"

namespace relume::bake {

LayerJob prepareLightmap(const LayerContext& context, const Parameters& parameters);  ///< "lightmap"
/// "lightgroups": one plane for each of scene::lightGroups.
LayerJob prepareLightGroups(const LayerContext& context, const Parameters& parameters);

}  // namespace relume::bake
