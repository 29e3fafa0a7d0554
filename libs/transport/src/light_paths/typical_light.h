// SPDX-License-Identifier: MIT
// How light spreads within a group of pieces when lamps stand all over the free space. A group has one value;
// that value times this shape is nearer to the truth than the value alone: what is hidden under a table
// neither gets the mean of its group nor shows it to the room. Without shapes coarse groups lose light, since
// their brightest parts are those that others see.
#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "light_paths/pieces.h"
#include "light_paths/sides.h"
#include "lightmap/reflectance.h"
#include "relume/core/progress.h"

namespace relume::transport {

/// What falls on pieces after one reflection or more, of `direct`, which falls on them straight from lights:
/// luminance by piece. Throws Error kInterrupted.
std::vector<float> reflectedLight(const Sides& sides, const Pieces& pieces,
                                  const MeanReflectance& reflectance, std::span<const float> direct,
                                  Progress& progress);

/// `light`, by piece, over its mean in the group of the piece: 1 where a group is dark, and all the nearer to
/// 1 for that the light is known from samples only. weight: of pieces in means, not negative. group:
/// scene::kNone for none.
std::vector<float> shapeWithin(std::span<const std::uint32_t> group, std::size_t groups,
                               std::span<const float> weight, std::span<const float> light);

/// By piece: area of its sides, hidden or not.
std::vector<float> areasOf(const Sides& sides, const Pieces& pieces);

}  // namespace relume::transport
