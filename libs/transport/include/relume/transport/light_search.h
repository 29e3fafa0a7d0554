// SPDX-License-Identifier: MIT
// Random lights in the free space of a scene: where people put lamps.
#pragma once
#include <cstdint>
#include <span>

#include "relume/core/light.h"
#include "relume/core/progress.h"
#include "relume/core/vec.h"
#include "relume/trace/tracer.h"

namespace relume::transport {

/// Where a test light may stand.
struct LightPlaces {
  float nearest = 0.0f;        ///< metres to any surface, at least
  float farthest = kInfinity;  ///< and at most
  float spots = 0.0f;          ///< share of spot lights, the rest are point lights
};

/// Points in `boxes`, uniformly, that are neither inside bodies nor outside of the scene: most of what they
/// see is the front of something. Where there are rooms, a hall in a field say, only places in rooms count.
/// White lights of intensity 1. Fewer than `count`, perhaps none, where such places are hard to find.
/// Throws Error kInterrupted.
LightSet findLights(const trace::Tracer& tracer, std::span<const Box3> boxes, std::uint32_t count,
                    const LightPlaces& places, std::uint64_t seed, Progress& progress);

}  // namespace relume::transport
