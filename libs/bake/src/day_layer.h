// SPDX-License-Identifier: MIT
// The light of a day at keyframes.
#pragma once
#include "relume/bake/registry.h"

namespace relume::bake {

WholeJob prepareDay(const LayerContext& context, const Parameters& parameters);  ///< "day"

}  // namespace relume::bake
