// SPDX-License-Identifier: MIT
#include "sample_table.h"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <set>

namespace relume::transport {
namespace {

constexpr std::uint32_t kColumns = SampleTable::kColumns;

/// Whether one sample of `rows` x `columns` lies in each of as many square cells.
bool isNet(const SampleTable& table, std::pair<std::uint32_t, std::uint32_t> rows,
           const std::set<std::uint32_t>& columns) {
  const std::uint32_t size = (rows.second - rows.first) * static_cast<std::uint32_t>(columns.size());
  const auto shift = 16 - std::countr_zero(size);
  std::set<std::uint32_t> cells;
  for (std::uint32_t s = rows.first; s < rows.second; ++s)
    for (const std::uint32_t c : columns) cells.insert(table.code[s * kColumns + c] >> shift);
  return cells.size() == size;
}

const std::set<std::uint32_t> kBlock = {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15};
const std::set<std::uint32_t> kQuarter = {2, 3, 6, 7};

TEST(SampleTable, SharedRoundsAreNetsOfTheBlockItsQuartersAndItsTexels) {
  const SampleTable table(16, 128, 7, BlockSamples::kShared);
  for (const auto& round :
       {std::pair(0u, 16u), std::pair(16u, 32u), std::pair(32u, 64u), std::pair(64u, 128u)}) {
    EXPECT_TRUE(isNet(table, round, kBlock));
    EXPECT_TRUE(isNet(table, round, kQuarter));
    for (const std::uint32_t c : kBlock) EXPECT_TRUE(isNet(table, round, {c}));
  }
}

TEST(SampleTable, SeparateColumnsAreNetsAtEveryPowerOfTwo) {
  const SampleTable table(16, 512, 7, BlockSamples::kSeparate);
  for (const std::uint32_t n : {16u, 32u, 64u, 128u, 256u, 512u})
    for (const std::uint32_t c : kBlock) EXPECT_TRUE(isNet(table, {0, n}, {c})) << n << " of column " << c;
}

TEST(SampleTable, SlotsOfAChunkAreCellsInMortonOrder) {
  for (const BlockSamples sharing : {BlockSamples::kShared, BlockSamples::kSeparate}) {
    const SampleTable table(32, 128, 3, sharing);
    for (const auto& [first, count] : {std::pair(0u, 32u), std::pair(32u, 32u), std::pair(64u, 64u)})
      for (std::uint32_t i = 0; i < count; ++i)
        for (std::uint32_t c = 0; c < kColumns; ++c)
          EXPECT_EQ(table.code[(first + i) * kColumns + c] >> (16 - std::countr_zero(count)), i);
  }
}

TEST(SampleTable, DirectionsAreUnitAndPlacesInTheSquare) {
  const SampleTable table(64, 256, 1, BlockSamples::kShared);
  double cosine = 0;
  for (std::size_t i = 0; i < table.x.size(); ++i) {
    EXPECT_NEAR(table.x[i] * table.x[i] + table.y[i] * table.y[i] + table.z[i] * table.z[i], 1.0f, 1e-5f);
    EXPECT_TRUE(table.u[i] >= 0 && table.u[i] < 1 && table.v[i] >= 0 && table.v[i] < 1);
    cosine += table.z[i] / static_cast<double>(table.x.size());
  }
  EXPECT_NEAR(cosine, 2.0 / 3.0, 1e-3);  // cosine-weighted; 4096 samples of a net
}

TEST(SampleTable, SeedsDiffer) {
  EXPECT_NE(SampleTable(16, 16, 1, BlockSamples::kShared).code,
            SampleTable(16, 16, 2, BlockSamples::kShared).code);
}

}  // namespace
}  // namespace relume::transport
