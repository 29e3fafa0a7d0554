// SPDX-License-Identifier: MIT
// From flux in texels to irradiance: sums over neighbours of flux and of area, each weighed by a kernel, and
// their quotient. Where a chart ends both end, so its rim is as bright as what lies inside. Neighbours of
// other charts, and beyond creases, have no part.
#pragma once
#include "lightmap/texel_lookup.h"
#include "photons/photon_map.h"
#include "relume/atlas/texels.h"

namespace relume::transport {

/// Fills value, error and sums of `result`. `unit`: W.
void estimateDensity(const PhotonMap& map, double unit, const atlas::Texels& texels,
                     const TexelLookup& lookup, const PhotonKernel& kernel, PhotonResult& result);

}  // namespace relume::transport
