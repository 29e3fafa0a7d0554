// SPDX-License-Identifier: MIT
// Exits of which nothing can be seen still have a value: filtering in viewers reaches into them.
#pragma once
#include <cstdint>
#include <vector>

#include "light_paths/sides.h"
#include "radiosity/patches.h"

namespace relume::transport {

/// By exit, which one's light it has: its own, or, where it is wholly buried, that of one of its chart that
/// is not, if any is near.
std::vector<std::uint32_t> gatheredFrom(const Patches& exits, const Sides& sides);

}  // namespace relume::transport
