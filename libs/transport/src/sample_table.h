// SPDX-License-Identifier: MIT
// The samples of all texels: 16 sequences, one for each place in a 4 x 4 block, the same for every block.
#pragma once
#include <cstdint>
#include <vector>

namespace relume::transport {

/// How the 16 sequences of a block go together.
enum class BlockSamples : std::uint8_t {
  kSeparate,  ///< every prefix of 2^m samples of a texel is a net: best for values that are used as they are
  kShared,    ///< every round of the block is one net of 16 times as many samples, dealt to its texels: best
              ///< for values that are smoothed over a block
};

/// Sample s of column c (the texel's place in its block, row by row) is element s * 16 + c of each array. A
/// round is a run of samples that the solver takes at once: [0, first), [first, 2 first), [2 first, 4
/// first)... It is made of chunks of up to kMaxBatch samples, each a net sorted along the Morton curve, so
/// that slot i of a chunk is in the same cell of the hemisphere for all columns.
class SampleTable {
 public:
  static constexpr std::uint32_t kColumns = 16;

  /// first, total: powers of two, first <= total <= kMaxSequence.
  SampleTable(std::uint32_t first, std::uint32_t total, std::uint64_t seed, BlockSamples sharing);

  std::vector<float> x, y, z;       ///< direction, cosine-weighted about +z
  std::vector<float> u, v;          ///< place in the footprint, [0, 1)
  std::vector<std::uint16_t> code;  ///< of DirectionBatch
};

}  // namespace relume::transport
