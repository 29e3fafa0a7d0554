// SPDX-License-Identifier: MIT
#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "relume/atlas/texels.h"

namespace relume::transport {

/// By point: itself where it is not `buried`, otherwise a point of its chart that is not, close by; itself
/// where the chart has none.
std::vector<std::uint32_t> substitutes(const atlas::Texels& texels, std::span<const std::uint8_t> buried);

}  // namespace relume::transport
