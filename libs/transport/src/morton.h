// SPDX-License-Identifier: MIT
// Bits of Morton codes: the Z-shaped curve through the cells of a square, 8 bits of each coordinate.
#pragma once
#include <cstdint>

namespace relume::transport {

/// Bits of x at even places.
constexpr std::uint32_t spreadBits(std::uint32_t x) {
  x = (x | (x << 4)) & 0x0f0fu;
  x = (x | (x << 2)) & 0x3333u;
  return (x | (x << 1)) & 0x5555u;
}

/// The inverse: every other bit of a Morton code.
constexpr std::uint32_t compactBits(std::uint32_t x) {
  x &= 0x5555u;
  x = (x | (x >> 1)) & 0x3333u;
  x = (x | (x >> 2)) & 0x0f0fu;
  return (x | (x >> 4)) & 0x00ffu;
}

}  // namespace relume::transport
