// SPDX-License-Identifier: MIT
// The rows of the registry that transport::solveOcclusion computes.
#pragma once
#include "relume/bake/registry.h"

namespace relume::bake {

LayerJob prepareOcclusion(const LayerContext& context, const Parameters& parameters);   ///< "ao"
LayerJob prepareObscurance(const LayerContext& context, const Parameters& parameters);  ///< "obscurance"
LayerJob prepareSpectral(const LayerContext& context, const Parameters& parameters);    ///< "spectral"

}  // namespace relume::bake
