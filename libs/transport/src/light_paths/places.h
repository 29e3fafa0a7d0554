// SPDX-License-Identifier: MIT
// Places all over groups of texel sides: where direct light on them is taken.
#pragma once
#include <cstdint>
#include <vector>

#include "light_paths/members.h"
#include "light_paths/pieces.h"
#include "light_paths/sides.h"
#include "lightmap/reflectance.h"
#include "relume/core/light.h"

namespace relume::transport {

struct Place {
  Point position{0};
  Normal shading_normal{0, 0, 1}, geometric_normal{0, 0, 1};
};

/// By side: how much of the light that falls there others see again, but for what it does in between. A mean
/// by area alone would be too low where surfaces lie upon each other: those hidden parts are dark, and nobody
/// sees them.
std::vector<float> reflectedShares(const Sides& sides, const Pieces& pieces,
                                   const MeanReflectance& reflectance);

/// `each` places on every group, equal shares of its weight each: strata along a curve through the group.
/// weight: by side, not negative. Shape: [groups][each]. Every group has a member. None lies where something
/// stands upon its texel.
std::vector<Place> placesOn(const SurfaceScene& scene, const Sides& sides, std::span<const float> weight,
                            const Members& groups, std::uint32_t each, std::uint64_t seed);

/// Irradiance at a place from one light, with a shadow ray to its middle; light from behind the surface does
/// not count. `stream`: of decisions about alpha.
Irradiance lightAt(const trace::Tracer& tracer, const Place& place, const Light& light, std::uint32_t stream);

}  // namespace relume::transport
