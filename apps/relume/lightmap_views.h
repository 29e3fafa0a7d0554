// SPDX-License-Identifier: MIT
// Pictures of light on the surfaces' colours, as a bake has it and as it ought to be.
#pragma once
#include <functional>

#include "comparison.h"
#include "lightmap_comparison.h"
#include "relume/picture/baked_values.h"
#include "relume/picture/picture.h"
#include "relume/transport/reference.h"

namespace relume::app {

/// What a view shows beside its truth.
struct ComparedLight {
  const picture::BakedValues& baked;
  transport::ReferenceOptions truth;  ///< of one half of the paths
  /// Irradiance that the bake does not hold, at a place that is seen.
  std::function<Vec3(const transport::Receiver&)> besides;
};

/// Both show base colour * E / pi + emission at the same places of the surfaces, E from the bake (bilinear)
/// or path-traced there: nothing differs but the light. Name and caption are left empty. Throws Error
/// kInterrupted.
ComparedView comparedView(const transport::Reference& reference, const ComparedLight& light,
                          const picture::Viewpoint& viewpoint, const ViewOptions& options, std::uint64_t seed,
                          Progress& progress);

/// The same of a lightmap.
ComparedView lightmapView(const transport::Reference& reference, const asset::Asset& asset,
                          const asset::Layer& layer, const picture::Viewpoint& viewpoint,
                          const ViewOptions& options, std::uint64_t seed, Progress& progress);

/// Paths for each place that a view is made of.
std::uint32_t samplesOfPlace(const ViewOptions& options);

}  // namespace relume::app
