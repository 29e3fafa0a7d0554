// SPDX-License-Identifier: MIT
#include "relume/codec/block_matrix.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>

#include "relume/core/error.h"

namespace relume::codec {
namespace {

// Two tiles that share row 1, two clusters whose columns are mixed, blocks of 1, 0, 2 and 1 components.
BlockMatrix example() {
  BlockMatrix m;
  m.rows = 3;
  m.columns = 4;
  m.tile_first = {0, 2, 4};
  m.tile_row = {0, 1, 1, 2};
  m.cluster_first = {0, 1, 4};
  m.cluster_column = {2, 0, 3, 1};
  m.component_first = {0, 1, 1, 3, 4};
  m.scale = {0.5f, 1.0f, 2.0f, 0.25f};
  m.planes8 = {10, 20, 1, 2, 3, 4, -8, 127};
  m.weights8 = {127, -127, 127, 127, 0, -127};
  return m;
}

BlockMatrix example16() {
  BlockMatrix m = example();
  m.bits = 16;
  m.planes16.assign(m.planes8.begin(), m.planes8.end());
  for (const std::int8_t q : m.weights8) m.weights16.push_back(static_cast<std::int16_t>(q / 127 * 32767));
  m.planes8.clear();
  m.weights8.clear();
  return m;
}

// By hand. Block (0, 0): 0.5 [10 20]; (1, 0): 1 [1 2] * -1 + 2 [3 4] * 1; (1, 1): 0.25 [-8 127] * [1 0 -1].
//           column 0    1       2   3
// row 0          0      0       5   0
// row 1         -2      2    10+5   0
// row 2      31.75  -31.75     6   0
constexpr float kDense[3][4] = {{0, 0, 5, 0}, {-2, 2, 15, 0}, {31.75f, -31.75f, 6, 0}};

TEST(BlockMatrix, MultipliesAsTheMatrixDoes) {
  for (const BlockMatrix& m : {example(), example16()}) {
    m.check();
    for (std::size_t j = 0; j < 4; ++j) {
      std::vector<float> x(4), y(3);
      x[j] = 1;
      multiply(m, x, y);
      for (std::size_t i = 0; i < 3; ++i)
        EXPECT_EQ(y[i], kDense[i][j]) << m.bits << " bits: " << i << ", " << j;
    }
  }
}

TEST(BlockMatrix, ChannelsShareWeights) {
  BlockMatrix m;
  m.rows = 2;
  m.columns = 1;
  m.channels = 3;
  m.tile_first = {0, 2};
  m.tile_row = {0, 1};
  m.cluster_first = {0, 1};
  m.cluster_column = {0};
  m.component_first = {0, 1};
  m.scale = {2};
  m.planes8 = {1, 2, 3, 4, 5, 6};
  m.weights8 = {-127};
  m.check();
  std::vector<float> y(6);
  multiply(m, std::vector<float>{1, 10, 100}, y);
  EXPECT_EQ(y, (std::vector<float>{-2, -60, -1000, -4, -80, -1200}));
}

TEST(BlockMatrix, WeightsAreCompandedBySquares) {
  EXPECT_EQ(weightOf(std::int8_t{127}), 1.0f);
  EXPECT_EQ(weightOf(std::int8_t{-127}), -1.0f);
  EXPECT_EQ(weightOf(std::int8_t{0}), 0.0f);
  EXPECT_FLOAT_EQ(weightOf(std::int8_t{-64}), -64.0f * 64.0f / (127.0f * 127.0f));
  EXPECT_EQ(weightOf(std::int16_t{32767}), 1.0f);
  EXPECT_FLOAT_EQ(weightOf(std::int16_t{-1000}), -1e6f / (32767.0f * 32767.0f));
}

TEST(BlockMatrix, OffsetsFollowBlocks) {
  const BlockOffsets o = offsets(example());
  EXPECT_EQ(o.plane, (std::vector<std::size_t>{0, 2, 2, 6, 8}));
  EXPECT_EQ(o.weight, (std::vector<std::size_t>{0, 1, 1, 3, 6}));
}

TEST(BlockMatrix, CountsItsMemory) {
  EXPECT_EQ(example().bytes(), 4u * (3 + 4 + 3 + 4 + 5 + 4) + 8 + 6);
  EXPECT_EQ(example16().bytes(), 4u * (3 + 4 + 3 + 4 + 5 + 4) + 2 * (8 + 6));
}

TEST(BlockMatrix, NothingIsAMatrixToo) {
  BlockMatrix m;
  m.tile_first = m.cluster_first = m.component_first = {0};
  m.check();
  multiply(m, {}, {});
}

TEST(BlockMatrix, RefusesWhatDoesNotFit) {
  using Damage = std::function<void(BlockMatrix&)>;
  const std::pair<const char*, Damage> damages[] = {
      {"channels", [](BlockMatrix& m) { m.channels = 2; }},
      {"bits", [](BlockMatrix& m) { m.bits = 9; }},
      {"samples of other bits", [](BlockMatrix& m) { m.bits = 16; }},
      {"samples of both bits", [](BlockMatrix& m) { m.weights16.push_back(0); }},
      {"no tile offsets", [](BlockMatrix& m) { m.tile_first.clear(); }},
      {"tiles begin late", [](BlockMatrix& m) { m.tile_first[0] = 1; }},
      {"tiles end early", [](BlockMatrix& m) { m.tile_first[2] = 3; }},
      {"tiles fall", [](BlockMatrix& m) { m.tile_first[1] = 5; }},
      {"row out of range", [](BlockMatrix& m) { m.tile_row[3] = 3; }},
      {"rows do not rise",
       [](BlockMatrix& m) {
         m.tile_row = {1, 0, 1, 2};
       }},
      {"row twice in a tile",
       [](BlockMatrix& m) {
         m.tile_row = {0, 0, 1, 2};
       }},
      {"row in no tile", [](BlockMatrix& m) { m.rows = 4; }},
      {"huge count of rows", [](BlockMatrix& m) { m.rows = 0xffffffffu; }},
      {"no cluster offsets", [](BlockMatrix& m) { m.cluster_first.clear(); }},
      {"clusters end early", [](BlockMatrix& m) { m.cluster_first[2] = 3; }},
      {"column missing", [](BlockMatrix& m) { m.cluster_column.pop_back(); }},
      {"column out of range", [](BlockMatrix& m) { m.cluster_column[0] = 4; }},
      {"column twice", [](BlockMatrix& m) { m.cluster_column[0] = 0; }},
      {"no block offsets", [](BlockMatrix& m) { m.component_first.clear(); }},
      {"a block less",
       [](BlockMatrix& m) {
         m.component_first = {0, 1, 1, 4};
       }},
      {"a block more", [](BlockMatrix& m) { m.component_first.push_back(4); }},
      {"blocks fall", [](BlockMatrix& m) { m.component_first[2] = 0; }},
      {"components beyond scales", [](BlockMatrix& m) { m.scale.pop_back(); }},
      {"component in another block", [](BlockMatrix& m) { m.component_first[1] = 0; }},
      {"infinite scale", [](BlockMatrix& m) { m.scale[2] = std::numeric_limits<float>::infinity(); }},
      {"scale not a number", [](BlockMatrix& m) { m.scale[2] = std::nanf(""); }},
      {"planes cut", [](BlockMatrix& m) { m.planes8.pop_back(); }},
      {"planes too long", [](BlockMatrix& m) { m.planes8.push_back(0); }},
      {"weights cut", [](BlockMatrix& m) { m.weights8.pop_back(); }},
      {"weights too long", [](BlockMatrix& m) { m.weights8.push_back(0); }},
      {"plane below range", [](BlockMatrix& m) { m.planes8[3] = -128; }},
      {"weight below range", [](BlockMatrix& m) { m.weights8[3] = -128; }},
  };
  for (const auto& [what, damage] : damages) {
    BlockMatrix m = example();
    damage(m);
    try {
      m.check();
      ADD_FAILURE() << what << ": accepted";
    } catch (const Error& e) {
      EXPECT_EQ(e.code(), ErrorCode::kCorruptAsset) << what;
    }
  }
}

}  // namespace
}  // namespace relume::codec
