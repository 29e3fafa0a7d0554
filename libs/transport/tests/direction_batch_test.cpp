// SPDX-License-Identifier: MIT
#include "direction_batch.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "relume/core/sampling.h"

namespace relume::transport {
namespace {

bool before(Vec3 a, Vec3 b) { return a.x != b.x ? a.x < b.x : a.y < b.y; }

TEST(DirectionBatch, HoldsThePointsOfTheSequence) {
  for (const std::uint32_t count : {1u, 2u, 4u, 16u, 64u, 128u, 256u}) {
    for (const std::uint32_t run : {0u, 1u, 2u, 7u, 200u}) {
      const std::uint32_t stream = 1234567u * run + count;
      DirectionBatch batch;
      directionBatch(run * count, count, stream, batch);
      std::vector<Vec3> expected, found;
      for (std::uint32_t i = 0; i < count; ++i) {
        expected.push_back(squareToCosineHemisphere(sobol2(run * count + i, stream)));
        found.emplace_back(batch.x[i], batch.y[i], batch.z[i]);
      }
      // Pairs by nearest neighbour: the warps differ by rounding.
      std::sort(expected.begin(), expected.end(), before);
      for (const Vec3& d : found) {
        float nearest = kInfinity;
        for (const Vec3& e : expected) nearest = std::min(nearest, glm::length(d - e));
        EXPECT_LT(nearest, 2e-6f);
        EXPECT_NEAR(glm::length(d), 1.0f, 1e-6f);
      }
    }
  }
}

TEST(DirectionBatch, SlotsAreCellsInMortonOrder) {
  for (const std::uint32_t count : {4u, 32u, 64u, 256u}) {
    DirectionBatch batch;
    directionBatch(3 * count, count, 42, batch);
    const std::uint32_t shift = kCodeBits - static_cast<std::uint32_t>(std::countr_zero(count));
    for (std::uint32_t i = 0; i < count; ++i) EXPECT_EQ(batch.code[i] >> shift, i);
  }
  // So 16 neighbours of 256 are a patch: within 57 degrees of each other, where unsorted ones spread over the
  // hemisphere.
  DirectionBatch batch;
  directionBatch(0, 256, 42, batch);
  for (std::uint32_t p = 0; p < 256; p += 16) {
    for (std::uint32_t i = p; i < p + 16; ++i) {
      EXPECT_GT(batch.x[p] * batch.x[i] + batch.y[p] * batch.y[i] + batch.z[p] * batch.z[i], 0.545f);
    }
  }
}

TEST(DirectionBatch, TheWholeSequenceIsANet) {
  constexpr std::uint32_t kCount = 1024;
  std::array<int, kCount> cells{};
  for (std::uint32_t first = 0; first < kCount; first += kMaxBatch) {
    DirectionBatch batch;
    directionBatch(first, kMaxBatch, 7, batch);
    for (const std::uint16_t code : batch.code) ++cells[code >> 6];
  }
  for (const int n : cells) EXPECT_EQ(n, 1);
}

// Mean of f(d) = z under pdf cos/pi is 2/3, of x^2 is 1/4.
TEST(DirectionBatch, IsCosineWeighted) {
  double z = 0, xx = 0;
  for (std::uint32_t stream = 0; stream < 16; ++stream) {
    DirectionBatch batch;
    directionBatch(0, 256, stream, batch);
    for (std::uint32_t i = 0; i < 256; ++i) z += batch.z[i] / 4096.0, xx += batch.x[i] * batch.x[i] / 4096.0;
  }
  EXPECT_NEAR(z, 2.0 / 3.0, 1e-3);
  EXPECT_NEAR(xx, 0.25, 1e-3);
}

TEST(SquareBatch, HoldsThePointsOfTheSequence) {
  SquareBatch batch;
  squareBatch(512, 64, 99, batch);
  std::vector<float> expected, found(batch.x.begin(), batch.x.begin() + 64);
  for (std::uint32_t i = 512; i < 576; ++i) expected.push_back(sobol2(i, 99).x);
  std::sort(expected.begin(), expected.end()), std::sort(found.begin(), found.end());
  EXPECT_EQ(expected, found);
}

}  // namespace
}  // namespace relume::transport
