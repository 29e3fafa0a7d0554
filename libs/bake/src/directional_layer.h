// SPDX-License-Identifier: MIT
// The row "directional": directional light maps.
#pragma once
#include "relume/bake/registry.h"

namespace relume::bake {

LayerJob prepareDirectional(const LayerContext& context, const Parameters& parameters);

}  // namespace relume::bake
