// SPDX-License-Identifier: MIT
// What a baked lightmap ought to hold, and how to path trace it.
#pragma once
#include <cstdint>
#include <string>

#include "relume/asset/asset.h"
#include "relume/transport/reference.h"

namespace relume::app {

/// The lightmap of that name; "": the first one. Throws Error kNoSuchLayer.
const asset::Layer& lightmapOf(const asset::Asset& asset, const std::string& name);

/// Options that trace the quantity that the layer holds: its part of the light, bounces and materials.
transport::ReferenceOptions truthOf(const asset::Layer& layer, std::uint32_t samples, std::uint64_t seed);

/// The seed of a truth that is independent of the one of `seed`.
std::uint64_t independentSeed(std::uint64_t seed);

}  // namespace relume::app
