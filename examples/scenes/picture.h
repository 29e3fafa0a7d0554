// SPDX-License-Identifier: MIT
// Small procedural textures.
#pragma once
#include <cstddef>
#include <vector>

namespace relume::scenes {

/// PNG, 128 x 128: 4 x 4 stone slabs of two tones with joints; repeats.
std::vector<std::byte> floorTiles();

}  // namespace relume::scenes
