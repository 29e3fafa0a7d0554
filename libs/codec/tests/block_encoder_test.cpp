// SPDX-License-Identifier: MIT
#include "block_encoder.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "relume/codec/block_matrix.h"

namespace relume::codec {
namespace {

Matrix randomMatrix(Eigen::Index rows, Eigen::Index columns, std::uint32_t seed) {
  std::mt19937 random(seed);
  std::normal_distribution<float> normal;
  return Matrix::NullaryExpr(rows, columns, [&] { return normal(random); });
}

// Products of smooth functions with spikes: singular values fall, some weights are large.
Matrix smoothMatrix(Eigen::Index rows, Eigen::Index columns) {
  return Matrix::NullaryExpr(rows, columns, [&](Eigen::Index r, Eigen::Index c) {
    const float x = static_cast<float>(r) / static_cast<float>(rows),
                y = static_cast<float>(c) / static_cast<float>(columns);
    return 1 / (0.002f + (x - y) * (x - y)) / 100;
  });
}

Matrix decoded(const BlockCode& code, Eigen::Index height, Eigen::Index width, std::size_t components) {
  Matrix out = Matrix::Zero(height, width);
  for (std::size_t k = 0; k < components; ++k)
    for (Eigen::Index r = 0; r < height; ++r)
      for (Eigen::Index c = 0; c < width; ++c)
        out(r, c) += code.scale[k] *
                     static_cast<float>(
                         code.planes[k * static_cast<std::size_t>(height) + static_cast<std::size_t>(r)]) *
                     weightOf(static_cast<std::int8_t>(
                         code.weights[k * static_cast<std::size_t>(width) + static_cast<std::size_t>(c)]));
  return out;
}

TEST(BlockEncoder, RoundsWeightsToTheNearestSquare) {
  std::vector<float> values;
  for (int i = -1000; i <= 1000; ++i) values.push_back(0.003f * static_cast<float>(i));
  std::vector<std::int16_t> q(values.size());
  const float scale = roundWeights(values, 127, q);
  EXPECT_FLOAT_EQ(scale, 3);
  for (std::size_t i = 0; i < values.size(); ++i) {
    float best = 1e9f;
    for (int j = -127; j <= 127; ++j)
      best = std::min(best, std::abs(scale * weightOf(static_cast<std::int8_t>(j)) - values[i]));
    EXPECT_NEAR(std::abs(scale * weightOf(static_cast<std::int8_t>(q[i])) - values[i]), best, 1e-6f)
        << values[i];
  }
}

TEST(BlockEncoder, RoundsPlanesWithinHalfAStep) {
  const std::vector<float> values = {0, 1, -2.54f, 0.013f, 2.5f};
  std::vector<std::int16_t> q(values.size());
  const float scale = roundPlane(values, 127, q);
  EXPECT_FLOAT_EQ(scale, 0.02f);
  EXPECT_EQ(q[2], -127);
  for (std::size_t i = 0; i < values.size(); ++i)
    EXPECT_LE(std::abs(scale * q[i] - values[i]), 0.5001f * scale);
  EXPECT_EQ(roundPlane(std::vector<float>(5), 127, q), 0.0f);
  EXPECT_EQ(roundWeights(std::vector<float>(5), 127, q), 0.0f);
}

class Blocks : public testing::Test {
 protected:
  const Matrix block_ = smoothMatrix(120, 80), lights_ = randomMatrix(30, 80, 1).cwiseAbs();
  const Matrix relative_ = Matrix::Ones(120, 30);

  BlockCode encode(const BlockOptions& options, double plain = 0.1) const {
    return encodeBlock(block_, {.lights = lights_, .plain = plain, .relative = relative_}, options);
  }
};

TEST_F(Blocks, NotesTheErrorThatIsThere) {
  const BlockCode code = encode({.most_rank = 20});
  ASSERT_EQ(code.components(), 20u);
  for (const std::size_t k : {0u, 1u, 7u, 20u}) {
    const Matrix error = block_ - decoded(code, 120, 80, k), product = error * lights_.transpose();
    const float* left = &code.left[k * 32];
    for (Eigen::Index l = 0; l < 30; ++l)
      EXPECT_NEAR(left[l], product.col(l).squaredNorm(), 1e-3f * product.col(l).squaredNorm() + 1e-3f);
    EXPECT_NEAR(left[30], error.squaredNorm(), 1e-3f * error.squaredNorm());
    EXPECT_NEAR(left[31], product.squaredNorm(), 1e-3f * product.squaredNorm());
  }
}

TEST_F(Blocks, RoundingAddsLittle) {
  // While what is left is well above the smallest step, 8 bits give what exact components give: the plane
  // that suits rounded weights is found anew, and later components mend earlier ones.
  const BlockCode code = encode({.most_rank = 30});
  for (std::size_t k = 1; k <= code.components(); ++k) {
    const float* left = &code.left[k * 32];
    double weighed = 0.1 * left[30];
    for (int l = 0; l < 30; ++l) weighed += left[l];
    const double relative = code.unrounded_left[k] / code.unrounded_left[0];
    if (relative < 1e-4) break;
    EXPECT_LT(weighed, 1.1 * code.unrounded_left[k]) << k << " components, " << relative;
  }
}

TEST_F(Blocks, StopsAtTheTolerance) {
  const BlockCode all = encode({.most_rank = 30});
  const double tolerance = 1e-3 * all.unrounded_left[0];
  const BlockCode code = encode({.tolerance = tolerance, .most_rank = 30});
  EXPECT_LE(code.unrounded_left.back(), tolerance);
  EXPECT_GT(code.unrounded_left[code.components() - 1], tolerance);
}

TEST_F(Blocks, LightsDecideWhatIsKept) {
  // All lights are of one rank-2 family: without a plain share two components do.
  const Matrix few = randomMatrix(30, 2, 3) * randomMatrix(2, 80, 4);
  const BlockCode code =
      encodeBlock(block_, {.lights = few, .plain = 0, .relative = relative_}, {.most_rank = 2, .max = 32767});
  const float* left = &code.left[2 * 32];
  EXPECT_LT(left[31], 1e-6f * code.left[31]);  // of the products
  EXPECT_GT(left[30], 0.1f * code.left[30]);   // of the block
}

TEST_F(Blocks, NothingTakesNoComponents) {
  const BlockCode code = encodeBlock(
      Matrix::Zero(120, 80), {.lights = lights_, .plain = 0.1, .relative = relative_}, {.most_rank = 4});
  EXPECT_EQ(code.components(), 0u);
}

}  // namespace
}  // namespace relume::codec
