// SPDX-License-Identifier: MIT
// Rows of texels from light that is traced from its sources.
#pragma once
#include <memory>

#include "relume/bake/registry.h"
#include "relume/basis/basis.h"
#include "relume/transport/photons.h"

namespace relume::bake {

/// As the parameters "paths", "kernel", "kernelwidth", "part", "bounces" and "materials" say.
transport::PhotonOptions photonOptionsOf(const LayerContext& context, const Parameters& parameters,
                                         std::shared_ptr<const basis::Basis> receiver);

/// Of the scene's lights and materials as well, but not of its surfaces.
Digest keyOf(const transport::PhotonOptions& options, const scene::Scene& scene);

/// All paths are shot when the first texel is asked for. Rows: E, its error, share of rays that meet backs,
/// then the receiver's sums.
TexelSolver photonSolver(const LayerContext& context, const transport::PhotonOptions& options);

}  // namespace relume::bake
