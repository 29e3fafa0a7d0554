// SPDX-License-Identifier: MIT
// From directional light at texels to directional light maps: how large a chart is in each direction's map,
// where it lies there, and what it holds.
#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "relume/asset/direction_maps.h"
#include "relume/atlas/texels.h"

namespace relume::bake {

/// `coefficients`: irradiance on planes perpendicular to the directions, shape [points][directions][3]. A
/// chart's rectangle has the texels of its place in the atlas, times scale^2, times the share of its area
/// that its projection along the direction has. Points that are not `valid` take from their neighbours.
asset::DirectionMaps packDirections(const atlas::Texels& texels, std::span<const Direction> directions,
                                    std::span<const float> coefficients, std::span<const std::uint8_t> valid,
                                    float scale);

}  // namespace relume::bake
