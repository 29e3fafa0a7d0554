// SPDX-License-Identifier: MIT
// The row of irradiance from the scene's own lights.
#pragma once
#include "relume/bake/registry.h"

namespace relume::bake {

LayerJob prepareLightmap(const LayerContext& context, const Parameters& parameters);

}  // namespace relume::bake
