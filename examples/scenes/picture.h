// SPDX-License-Identifier: MIT
// Small procedural textures.
#pragma once
#include <cstddef>
#include <vector>

namespace relume::scenes {

/// PNG, 128 x 128: 4 x 4 stone slabs of two tones with joints; repeats.
std::vector<std::byte> floorTiles();

enum class ReliefPattern { kCobbles, kBricks };

/// PNG, 128 x 128, that repeat: what a surface is painted with, and how high it is (grey, white on top).
struct ReliefPictures {
  std::vector<std::byte> colours, heights;
};
ReliefPictures reliefOf(ReliefPattern pattern);

}  // namespace relume::scenes
