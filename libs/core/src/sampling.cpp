// SPDX-License-Identifier: MIT
#include "relume/core/sampling.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace relume {
namespace {

std::uint32_t reverseBits(std::uint32_t x) {
  x = ((x & 0xaaaaaaaau) >> 1) | ((x & 0x55555555u) << 1);
  x = ((x & 0xccccccccu) >> 2) | ((x & 0x33333333u) << 2);
  x = ((x & 0xf0f0f0f0u) >> 4) | ((x & 0x0f0f0f0fu) << 4);
  return __builtin_bswap32(x);
}

// A permutation in which bit i of the result depends on bits 0..i only: on reversed bits, an Owen scramble.
// The constants are Vegdahl's improvement of [Burley20] Section 3.2.
std::uint32_t nestedUniformScrambleReversed(std::uint32_t x, std::uint32_t seed) {
  x ^= x * 0x3d20adeau;
  x += seed;
  x *= (seed >> 16) | 1u;
  x ^= x * 0x05526c56u;
  x ^= x * 0x53a22864u;
  return x;
}

// Sobol's second dimension (primitive polynomial x + 1), as one matrix column per index bit, bits reversed so
// that the result is ready for the scramble above. The first dimension is the van der Corput sequence:
// reversed, the index itself.
constexpr std::array<std::uint32_t, 32> secondDimension() {
  std::array<std::uint32_t, 32> columns{};
  std::uint32_t column = 0x80000000u;
  for (int bit = 0; bit < 32; ++bit) {
    std::uint32_t reversed = 0;
    for (int i = 0; i < 32; ++i) reversed |= ((column >> i) & 1u) << (31 - i);
    columns[static_cast<std::size_t>(bit)] = reversed;
    column ^= column >> 1;
  }
  return columns;
}
constexpr auto kSecondDimension = secondDimension();

float toUnit(std::uint32_t bits) { return static_cast<float>(bits >> 8) * 0x1p-24f; }

}  // namespace

std::uint32_t hashCombine(std::uint32_t a, std::uint32_t b) {
  // Two rounds of the murmur3 finalizer over a Weyl-spread sum.
  std::uint32_t x = a * 0x9e3779b9u + b;
  for (int round = 0; round < 2; ++round) {
    x ^= x >> 16, x *= 0x85ebca6bu;
    x ^= x >> 13, x *= 0xc2b2ae35u;
    x ^= x >> 16;
    x += b * 0x27d4eb2fu + 0x165667b1u;
  }
  return x ^ (x >> 15);
}

Vec2 Sobol2::operator()(std::uint32_t index) const {
  // Shuffle the order within each power-of-two block (an Owen scramble of the index), then scramble each
  // coordinate.
  const std::uint32_t i = reverseBits(nestedUniformScrambleReversed(reverseBits(index), order_));
  std::uint32_t y = 0;
  for (std::uint32_t rest = i; rest; rest &= rest - 1)
    y ^= kSecondDimension[static_cast<std::size_t>(__builtin_ctz(rest))];
  const std::uint32_t x = nestedUniformScrambleReversed(i, first_);
  y = nestedUniformScrambleReversed(y, second_);
  return {toUnit(reverseBits(x)), toUnit(reverseBits(y))};
}

Vec2 sobol2(std::uint32_t index, std::uint32_t stream) { return Sobol2(stream)(index); }

Vec2 squareToDisk(Vec2 u) {
  const float a = 2.0f * u.x - 1.0f, b = 2.0f * u.y - 1.0f;
  if (a == 0.0f && b == 0.0f) return {0.0f, 0.0f};
  float r, phi;
  if (std::abs(a) > std::abs(b)) {
    r = a, phi = (kPi / 4) * (b / a);
  } else {
    r = b, phi = (kPi / 2) - (kPi / 4) * (a / b);
  }
  return {r * std::cos(phi), r * std::sin(phi)};
}

Direction squareToCosineHemisphere(Vec2 u) {
  const Vec2 d = squareToDisk(u);
  const float z = std::sqrt(std::max(0.0f, 1.0f - d.x * d.x - d.y * d.y));
  return {d.x, d.y, std::max(z, 1e-4f)};
}

Direction squareToSphere(Vec2 u) {
  const float z = 1.0f - 2.0f * u.x;
  const float r = std::sqrt(std::max(0.0f, 1.0f - z * z));
  const float phi = 2.0f * kPi * u.y;
  return {r * std::cos(phi), r * std::sin(phi), z};
}

}  // namespace relume
