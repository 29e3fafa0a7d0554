// SPDX-License-Identifier: MIT
#include "picture.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

#define STB_IMAGE_WRITE_IMPLEMENTATION
#define STB_IMAGE_WRITE_STATIC
#if defined(__GNUC__)
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wunused-function"
#pragma GCC diagnostic ignored "-Wmissing-field-initializers"
#endif
#include <stb/stb_image_write.h>
#if defined(__GNUC__)
#pragma GCC diagnostic pop
#endif

namespace relume::scenes {
namespace {

constexpr int kSize = 128, kSlab = kSize / 4;

std::uint32_t hash(std::uint32_t x) {
  x ^= x >> 16, x *= 0x7feb352du, x ^= x >> 15, x *= 0x846ca68bu;
  return x ^ (x >> 16);
}

// Value noise on a lattice of `cell` pixels, 0..255; repeats with the texture.
int noise(int x, int y, int cell, std::uint32_t seed) {
  const int n = kSize / cell, cx = x / cell, cy = y / cell, fx = x % cell, fy = y % cell;
  const auto at = [&](int i, int j) {
    return int(hash(std::uint32_t((i % n) + (j % n) * 977) * 2654435761u + seed) & 255u);
  };
  const int top = at(cx, cy) * (cell - fx) + at(cx + 1, cy) * fx,
            low = at(cx, cy + 1) * (cell - fx) + at(cx + 1, cy + 1) * fx;
  return (top * (cell - fy) + low * fy) / (cell * cell);
}

std::vector<std::byte> pngOf(const std::vector<std::uint8_t>& pixels, int channels) {
  std::vector<std::byte> png;
  const auto take = [](void* out, void* data, int size) {
    const auto* bytes = static_cast<const std::byte*>(data);
    auto* to = static_cast<std::vector<std::byte>*>(out);
    to->insert(to->end(), bytes, bytes + size);
  };
  stbi_write_png_to_func(take, &png, kSize, kSize, channels, pixels.data(), kSize * channels);
  return png;
}

struct Stone {
  int number;     ///< which
  double inside;  ///< 0 at its rim, 1 where it is flat
};

// Eight rows of four, every second one moved by half a brick.
Stone brickAt(int x, int y) {
  constexpr int kRow = kSize / 8, kLength = kSize / 4;
  const int row = y / kRow, along = (x + (row % 2) * kLength / 2) % kSize;
  const int u = along % kLength, v = y % kRow;
  const double rim = std::min({u, kLength - 1 - u, v, kRow - 1 - v}) - 0.5;
  return {row * 4 + along / kLength, rim / 2.5};
}

// The nearest of 8 x 8 points of a shaken grid; the rim is where two are as near.
Stone cobbleAt(int x, int y) {
  constexpr int kCells = 8, kCell = kSize / kCells;
  double first = 1e9, second = 1e9;
  int number = 0;
  for (int j = y / kCell - 2; j <= y / kCell + 2; ++j)
    for (int i = x / kCell - 2; i <= x / kCell + 2; ++i) {
      const int id = (i + kCells) % kCells + kCells * ((j + kCells) % kCells);
      const std::uint32_t shake = hash(std::uint32_t(id) + 101u);
      const double px = kCell * (i + 0.2 + 0.6 * double(shake & 255u) / 255),
                   py = kCell * (j + 0.2 + 0.6 * double(shake >> 8 & 255u) / 255);
      const double d = std::sqrt((x - px) * (x - px) + (y - py) * (y - py));
      if (d < first)
        second = first, first = d, number = id;
      else
        second = std::min(second, d);
    }
  return {number, (second - first - 1.5) / 7};
}

}  // namespace

std::vector<std::byte> floorTiles() {
  std::vector<std::uint8_t> pixels;
  for (int y = 0; y < kSize; ++y)
    for (int x = 0; x < kSize; ++x) {
      const int i = x / kSlab, j = y / kSlab, u = x % kSlab, v = y % kSlab;
      const bool joint = u == 0 || v == 0;
      const bool light = (i + j) % 2 == 0;
      const int slab = int(hash(std::uint32_t(i * 7 + j * 31)) % 17u) - 8;
      const int grain = (noise(x, y, 16, 1) - 128) / 14 + (noise(x, y, 4, 2) - 128) / 24;
      const int rgb[2][3] = {{112, 78, 62}, {196, 184, 160}};
      for (int c = 0; c < 3; ++c) {
        const int value = joint ? 92 - 8 * c : rgb[light][c] + slab + grain;
        pixels.push_back(std::uint8_t(std::clamp(value / 2 * 2, 0, 255)));
      }
    }
  return pngOf(pixels, 3);
}

ReliefPictures reliefOf(ReliefPattern pattern) {
  std::vector<std::uint8_t> colours, heights;
  for (int y = 0; y < kSize; ++y)
    for (int x = 0; x < kSize; ++x) {
      const Stone stone = pattern == ReliefPattern::kCobbles ? cobbleAt(x, y) : brickAt(x, y);
      // Rounded to the joint, with a grain on top.
      const double edge = std::clamp(stone.inside, 0.0, 1.0), round = edge * (2 - edge);
      const int grain = noise(x, y, 8, 3) - 128, fine = noise(x, y, 2, 4) - 128;
      const int top = 196 + int(hash(std::uint32_t(stone.number) + 17u) % 48u);
      heights.push_back(std::uint8_t(std::clamp(int(top * round) + grain / 12 + fine / 24, 0, 255)));
      const int tone = int(hash(std::uint32_t(stone.number)) % 41u) - 20 + grain / 12 + fine / 10;
      constexpr int kTones[2][2][3] = {{{70, 66, 60}, {140, 134, 126}}, {{150, 142, 130}, {158, 86, 66}}};
      const auto& [joint, body] = kTones[pattern == ReliefPattern::kBricks];
      for (int c = 0; c < 3; ++c)
        colours.push_back(std::uint8_t(std::clamp(
            int(joint[c] + (body[c] + tone - joint[c]) * std::min(1.0, 4 * edge)) / 2 * 2, 0, 255)));
    }
  return {pngOf(colours, 3), pngOf(heights, 1)};
}

}  // namespace relume::scenes
