// SPDX-License-Identifier: MIT
// How the samples of a sequence are dealt to the 16 columns of a table: see BlockSamples.
#pragma once
#include <algorithm>
#include <cstdint>

#include "direction_batch.h"
#include "sample_table.h"

namespace relume::transport {

/// Places of a 4 x 4 block, row by row, as steps along the Morton curve.
constexpr std::uint32_t mortonOf(std::uint32_t column) {
  const std::uint32_t px = column % 4, py = column / 4;
  return (px & 1u) | ((py & 1u) << 1) | ((px & 2u) << 1) | ((py & 2u) << 2);
}

/// Calls fill(first slot, count, column, first index of the sequence) for every chunk of every column. Rounds
/// are [0, first), [first, 2 first), [2 first, 4 first)... up to total; all powers of two.
template <class Fill>
void forEachChunk(std::uint32_t first, std::uint32_t total, BlockSamples sharing, const Fill& fill) {
  constexpr std::uint32_t kColumns = SampleTable::kColumns;
  for (std::uint32_t done = 0; done < total;) {
    const std::uint32_t round = done == 0 ? first : done, chunk = std::min(round, kMaxBatch);
    for (std::uint32_t begin = done; begin < done + round; begin += chunk) {
      for (std::uint32_t column = 0; column < kColumns; ++column) {
        const std::uint32_t part = mortonOf(column);
        fill(begin, chunk, column,
             sharing == BlockSamples::kShared ? kColumns * done + part * round + (begin - done)
                                              : part * total + begin);
      }
    }
    done += round;
  }
}

}  // namespace relume::transport
