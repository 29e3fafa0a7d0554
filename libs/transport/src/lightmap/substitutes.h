// SPDX-License-Identifier: MIT
#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "relume/atlas/texels.h"

namespace relume::transport {

/// By point: itself where it is not `buried`, otherwise a point of its chart that is not, at most a few
/// texels away; itself where there is none: in the middle of a buried stretch, or where much is seen from
/// behind.
std::vector<std::uint32_t> substitutes(const atlas::Texels& texels, std::span<const std::uint8_t> buried);

}  // namespace relume::transport
