// SPDX-License-Identifier: MIT
// From a scene with its texels to what the texels send out, by way of patches.
#pragma once
#include "lightmap/radiance_cache.h"
#include "relume/transport/radiosity.h"

namespace relume::transport {

struct RadiosityScene {
  const trace::Tracer& tracer;
  const TexelLookup& lookup;
  const atlas::Texels& texels;
  const TexelGroups& groups;
};

struct RadiosityTask {
  RadiosityOptions options;
  Materials materials = Materials::kFull;  ///< kFull: glossy lobes reflect their mean over directions
  int bounces = -1;                        ///< reflections of light that a texel may gather; negative: all
  std::uint64_t seed = 1;
};

/// Light that texels reflect, and their irradiance by patch. `error` holds two parts, by patch: the noise of
/// form factors, from the scatter of what its rays bring; and the size of patches, as the difference of what
/// it gathers from these patches and from those of twice the side (none where a chart is no larger than a
/// patch). Not in it: the noise of direct light on
/// patches, and form factors of hemicubes that stand too close to something. Bits do not depend on the number
/// of threads. Throws Error kInterrupted.
RadianceCache::Known radiosity(const RadiosityScene& scene, const RadiosityTask& task, Progress& progress);

}  // namespace relume::transport
