// SPDX-License-Identifier: MIT
// sobol2 of core/sampling.h for whole aligned runs of indices: the same points, some ten times faster,
// because a run is closed under the shuffle of the index, so that its points can be made in any order,
// without branches, and each falls into its own cell. Based on:
//   [Burley20] Burley. Practical Hash-based Owen Scrambling. JCGT 9(4), 2020.
//   [Shirley97] Shirley, Chiu. A Low Distortion Map Between Disk and Square. 1997.
#include "direction_batch.h"

#include <bit>
#include <cmath>

#include "morton.h"
#include "relume/core/check.h"
#include "relume/core/sampling.h"

namespace relume::transport {
namespace {

inline std::uint32_t reverseBits(std::uint32_t x) {
  x = ((x & 0xaaaaaaaau) >> 1) | ((x & 0x55555555u) << 1);
  x = ((x & 0xccccccccu) >> 2) | ((x & 0x33333333u) << 2);
  x = ((x & 0xf0f0f0f0u) >> 4) | ((x & 0x0f0f0f0fu) << 4);
  return __builtin_bswap32(x);
}

// As in core/sampling.cpp; the test that compares both sets of points holds them together.
inline std::uint32_t nestedUniformScrambleReversed(std::uint32_t x, std::uint32_t seed) {
  x ^= x * 0x3d20adeau;
  x += seed;
  x *= (seed >> 16) | 1u;
  x ^= x * 0x05526c56u;
  x ^= x * 0x53a22864u;
  return x;
}

/// Sobol's second dimension, bits reversed: column i is row i of Pascal's triangle modulo 2.
constexpr auto kColumns = [] {
  std::array<std::uint32_t, 32> columns{};
  std::uint32_t c = 1;
  for (std::uint32_t& column : columns) column = c, c ^= c << 1;
  return columns;
}();

constexpr std::uint32_t secondDimension(std::uint32_t index) {
  std::uint32_t y = 0;
  for (; index != 0; index &= index - 1) y ^= kColumns[static_cast<std::size_t>(std::countr_zero(index))];
  return y;
}

constexpr auto kLowSecondDimension = [] {
  std::array<std::uint32_t, kMaxBatch> y{};
  for (std::uint32_t i = 0; i < kMaxBatch; ++i) y[i] = secondDimension(i);
  return y;
}();

struct alignas(64) Bits {
  std::array<std::uint32_t, kMaxBatch> x, y;
};

/// The run's points as 32-bit fractions, in the order of the unshuffled sequence.
void points(std::uint32_t first, std::uint32_t count, std::uint32_t stream, Bits& bits) {
  RELUME_CHECK(std::has_single_bit(count) && count <= kMaxBatch && first % count == 0);
  const std::uint32_t shuffled =
      reverseBits(nestedUniformScrambleReversed(reverseBits(first), hashCombine(stream, 0x68bc21ebu)));
  const std::uint32_t high = shuffled & ~(count - 1), high_y = secondDimension(high);
  const std::uint32_t seed_x = hashCombine(stream, 0x02e5be93u), seed_y = hashCombine(stream, 0x967a889bu);
  for (std::uint32_t i = 0; i < count; ++i) {
    bits.x[i] = reverseBits(nestedUniformScrambleReversed(high | i, seed_x));
    bits.y[i] = reverseBits(nestedUniformScrambleReversed(high_y ^ kLowSecondDimension[i], seed_y));
  }
}

inline float toUnit(std::uint32_t bits) { return static_cast<float>(bits >> 8) * 0x1p-24f; }

}  // namespace

void directionBatch(std::uint32_t first, std::uint32_t count, std::uint32_t stream, DirectionBatch& batch) {
  Bits bits;
  points(first, count, stream, bits);
  alignas(64) std::array<float, kMaxBatch> x, y, z;
  alignas(64) std::array<std::uint32_t, kMaxBatch> code;
  for (std::uint32_t i = 0; i < count; ++i) {
    const float a = 2.0f * toUnit(bits.x[i]) - 1.0f, b = 2.0f * toUnit(bits.y[i]) - 1.0f;
    const bool wide = std::abs(a) > std::abs(b);
    const float r = wide ? a : b, other = wide ? b : a;
    const float angle =
        (0.785398163f * other) / (r == 0.0f ? 1.0f : r);  // |angle| <= pi/4: Taylor is exact to rounding
    const float q = angle * angle;
    const float s =
        angle * (1.0f + q * (-1.0f / 6 + q * (1.0f / 120 + q * (-1.0f / 5040 + q * (1.0f / 362880)))));
    const float c = 1.0f + q * (-0.5f + q * (1.0f / 24 + q * (-1.0f / 720 + q * (1.0f / 40320))));
    x[i] = r * (wide ? c : s);
    y[i] = r * (wide ? s : c);
    z[i] = std::max(std::sqrt(std::max(0.0f, 1.0f - r * r)), 1e-4f);
    code[i] = (spreadBits(bits.x[i] >> 24) << 1) | spreadBits(bits.y[i] >> 24);
  }
  const std::uint32_t shift = kCodeBits - static_cast<std::uint32_t>(std::countr_zero(count));
  for (std::uint32_t i = 0; i < count; ++i) {
    const std::uint32_t slot = code[i] >> shift;
    batch.x[slot] = x[i], batch.y[slot] = y[i], batch.z[slot] = z[i];
    batch.code[slot] = static_cast<std::uint16_t>(code[i]);
  }
}

void squareBatch(std::uint32_t first, std::uint32_t count, std::uint32_t stream, SquareBatch& batch) {
  Bits bits;
  points(first, count, stream, bits);
  for (std::uint32_t i = 0; i < count; ++i) batch.x[i] = toUnit(bits.x[i]), batch.y[i] = toUnit(bits.y[i]);
}

}  // namespace relume::transport
