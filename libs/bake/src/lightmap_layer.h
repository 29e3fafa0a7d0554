// SPDX-License-Identifier: MIT
// The rows of irradiance from the scene's own lights.
#pragma once
#include <memory>

#include "relume/bake/registry.h"
#include "relume/basis/basis.h"

namespace relume::bake {

/// Irradiance, and beside it in one plane of as many channels what `basis` sums up; for layers that keep it
/// in their own way. Parameters: "solver" (gather or photon) and what that has.
LayerJob prepareSums(const LayerContext& context, const Parameters& parameters,
                     std::shared_ptr<const basis::Basis> basis);
LayerJob prepareLightmap(const LayerContext& context, const Parameters& parameters);  ///< "lightmap"
/// "lightgroups": one plane for each of scene::lightGroups.
LayerJob prepareLightGroups(const LayerContext& context, const Parameters& parameters);

}  // namespace relume::bake
