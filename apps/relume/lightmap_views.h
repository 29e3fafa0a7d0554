// SPDX-License-Identifier: MIT
// Pictures of a lightmap on the surfaces' colours, as the lightmap is and as it ought to be.
#pragma once
#include "comparison.h"
#include "lightmap_comparison.h"
#include "relume/picture/picture.h"
#include "relume/transport/reference.h"

namespace relume::app {

/// Both show base colour * E / pi + emission at the same places of the surfaces, E from the layer (bilinear)
/// or path-traced there: nothing differs but the light. Name and caption are left empty. Throws Error
/// kInterrupted.
ComparedView lightmapView(const transport::Reference& reference, const asset::Asset& asset,
                          const asset::Layer& layer, const picture::Viewpoint& viewpoint,
                          const ViewOptions& options, std::uint64_t seed, Progress& progress);

}  // namespace relume::app
