// SPDX-License-Identifier: MIT
#pragma once
#include "light_paths/clusters.h"
#include "relume/transport/light_paths.h"

namespace relume::transport {

/// Tiles of about `each` exits by Lloyd's method, which overlap by a share `overlap` of their exits: an exit
/// belongs to all tiles whose middles are at most a band farther than the nearest one, and its weight falls
/// off linearly over the band, so that nothing jumps from exit to exit.
ExitTiles makeTiles(std::span<const Exit> exits, std::uint32_t each, float overlap, std::uint64_t seed,
                    Progress& progress);

}  // namespace relume::transport
