// SPDX-License-Identifier: MIT
// How long a solver will take, from a small part of its work.
#pragma once
#include <cstdint>
#include <functional>
#include <span>

#include "relume/atlas/texels.h"
#include "relume/bake/registry.h"

namespace relume::bake {

/// Seconds since some moment.
using Clock = std::function<double()>;
double steadySeconds();

/// Seconds that `solver` needs for the texels `pending` (ascending indices into Texels::points), as this
/// machine runs it now. What a solver does once, before its first texel (a lightmap's cache of radiance), is
/// done in full and timed apart; then blocks from all over the atlas are solved until they have taken long
/// enough to tell the rest. Throws Error kInterrupted.
double forecastSeconds(const TexelSolver& solver, const atlas::Texels& texels,
                       std::span<const std::uint32_t> pending, Progress& progress,
                       const Clock& now = steadySeconds);

}  // namespace relume::bake
