// SPDX-License-Identifier: MIT
#include "picture.h"

#include <algorithm>
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
  std::vector<std::byte> png;
  const auto take = [](void* out, void* data, int size) {
    const auto* bytes = static_cast<const std::byte*>(data);
    auto* to = static_cast<std::vector<std::byte>*>(out);
    to->insert(to->end(), bytes, bytes + size);
  };
  stbi_write_png_to_func(take, &png, kSize, kSize, 3, pixels.data(), kSize * 3);
  return png;
}

}  // namespace relume::scenes
