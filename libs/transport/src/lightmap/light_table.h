// SPDX-License-Identifier: MIT
// The samples of light of all texels: as sample_table.h, for places on lights instead of directions.
#pragma once
#include <cstdint>
#include <vector>

#include "sample_table.h"

namespace relume::transport {

/// Sample s of column c is element s * 16 + c. Chunks of up to kMaxBatch samples are nets over the place on
/// the light, sorted along its Morton curve.
class LightTable {
 public:
  static constexpr std::uint32_t kColumns = SampleTable::kColumns;

  /// As SampleTable.
  LightTable(std::uint32_t first, std::uint32_t total, std::uint64_t seed, BlockSamples sharing);

  std::vector<float> place_x, place_y;  ///< on the light, [0, 1)
  std::vector<float> choice;            ///< of the light, [0, 1)
  std::vector<float> u, v;              ///< in the footprint, [0, 1)
};

}  // namespace relume::transport
