// SPDX-License-Identifier: MIT
// Random lights in the free space of a scene.
#pragma once
#include "relume/core/light.h"
#include "relume/core/progress.h"
#include "relume/trace/tracer.h"
#include "relume/transport/light_paths.h"

namespace relume::transport {

/// Points in `boxes`, uniformly, that are neither inside bodies nor outside of the scene: most of what they
/// see is the front of something. Where there are rooms, a hall in a field say, only places in rooms count.
/// White lights of intensity 1. May be fewer than `count`.
LightSet findLights(const trace::Tracer& tracer, std::span<const Box3> boxes, std::uint32_t count,
                    const LightPlaces& places, std::uint64_t seed, Progress& progress);

}  // namespace relume::transport
