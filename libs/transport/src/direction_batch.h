// SPDX-License-Identifier: MIT
// Low-discrepancy directions by the batch, sorted so that neighbours in the list are neighbours on the
// hemisphere.
#pragma once
#include <array>
#include <cstdint>

namespace relume::transport {

inline constexpr std::uint32_t kMaxBatch = 256;

/// Bits of a cell code: enough for a sequence of 2^16 samples.
inline constexpr std::uint32_t kCodeBits = 16;
inline constexpr std::uint32_t kMaxSequence = 1u << kCodeBits;

struct alignas(64) DirectionBatch {
  std::array<float, kMaxBatch> x, y, z;  ///< cosine-weighted about +z
  std::array<std::uint16_t, kMaxBatch>
      code;  ///< Morton code of the point of the unit square: 8 bits of each coordinate
};

struct alignas(64) SquareBatch {
  std::array<float, kMaxBatch> x, y;  ///< [0, 1)
};

/// The points sobol2(first .. first + count - 1, stream), as directions. count: a power of two up to
/// kMaxBatch; first: a multiple of it. Such a run has one point in each cell of a 2^ceil(m/2) x 2^floor(m/2)
/// grid, 2^m = count, and slot i holds the point of the i-th cell along the Morton curve, so code[i] >> (16 -
/// m) = i.
void directionBatch(std::uint32_t first, std::uint32_t count, std::uint32_t stream, DirectionBatch& batch);

/// The points of an aligned run of another stream, in the sequence's own order, for the second pair of
/// dimensions. Slot i of a direction batch goes with point i: the directions of any aligned run of slots, a
/// patch of the hemisphere, then meet a whole net.
void squareBatch(std::uint32_t first, std::uint32_t count, std::uint32_t stream, SquareBatch& batch);

}  // namespace relume::transport
