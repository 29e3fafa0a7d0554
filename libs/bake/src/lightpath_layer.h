// SPDX-License-Identifier: MIT
// The row "lightpath" of the registry: light path maps (transport/light_paths.h), encoded.
#pragma once
#include "relume/bake/registry.h"

namespace relume::bake {

WholeJob prepareLightPaths(const LayerContext& context, const Parameters& parameters);

}  // namespace relume::bake
