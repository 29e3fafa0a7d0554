// SPDX-License-Identifier: MIT
#include "block_product.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <string>

#include "made_bake.h"
#include "relume/core/error.h"
#include "relume/core/parallel.h"

namespace relume::relight {
namespace {

std::vector<Irradiance> randomIrradiance(std::size_t count, std::uint32_t seed = 3) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> unit;
  std::vector<Irradiance> x(count);
  for (Irradiance& e : x)
    e.rgb = std::pow(10.0f, 4 * unit(random) - 2) * Vec3(unit(random), unit(random), unit(random));
  return x;
}

std::vector<Irradiance> product(BlockProduct& p, const std::vector<Irradiance>& x) {
  std::vector<Irradiance> y(p.rows(), Irradiance(-1.0f));
  p.multiply(x, y);
  return y;
}

// codec::multiply, colour by colour where the matrix has one channel.
std::vector<Irradiance> plainProduct(const codec::BlockMatrix& m, const std::vector<Irradiance>& x) {
  std::vector<Irradiance> y(m.rows);
  const int passes = m.channels == 1 ? 3 : 1;
  for (int pass = 0; pass < passes; ++pass) {
    std::vector<float> in, out(std::size_t{m.rows} * m.channels);
    for (const Irradiance& e : x)
      for (std::uint32_t c = 0; c < m.channels; ++c)
        in.push_back(e.rgb[passes == 3 ? pass : static_cast<int>(c)]);
    codec::multiply(m, in, out);
    for (std::size_t i = 0; i < out.size(); ++i)
      y[i / m.channels].rgb[passes == 3 ? pass : static_cast<int>(i % m.channels)] = out[i];
  }
  return y;
}

// Largest magnitude that a row could have: the scale of what rounding of factors may cost.
std::vector<MadeMatrix> matrices() {
  return {
      {},
      {.channels = 1},
      {.bits = 16},
      {.channels = 1, .bits = 16},
      {.rows = 1, .columns = 1, .tiles = 1, .clusters = 1, .rank = 1, .overlap = 0, .exact_rank = true},
      {.rows = 700, .columns = 333, .tiles = 2, .clusters = 7, .rank = 90, .overlap = 40},  // several groups
                                                                                            // of planes
      {.rows = 5000, .columns = 64, .tiles = 1, .clusters = 8, .rank = 9, .overlap = 0},  // as clustered PCA
      {.rows = 3000, .columns = 64, .bits = 16, .tiles = 1, .clusters = 8, .rank = 40, .overlap = 0},
      {.rows = 200, .columns = 50, .tiles = 12, .clusters = 3, .rank = 4, .overlap = 60}};  // rows of many
                                                                                            // tiles
}

// Rounding of factors to 16 bits: an error of at most 1/2 of 1/32767 of the largest factor of each plane
// times its sample, of either sign; errors of floats beside it. Judged by the RMS over rows.
TEST(BlockProduct, AgreesWithThePlainProduct) {
  for (const MadeMatrix& want : matrices()) {
    SCOPED_TRACE(testing::Message() << want.rows << " x " << want.columns << ", " << want.bits
                                    << " bits, rank " << want.rank);
    const codec::BlockMatrix m = madeMatrix(want);
    BlockProduct fast(m);
    const auto x = randomIrradiance(m.columns);
    const auto got = product(fast, x), expected = plainProduct(m, x);
    double error = 0, size = 0;
    for (std::size_t i = 0; i < m.rows; ++i) {
      error += glm::dot(got[i].rgb - expected[i].rgb, got[i].rgb - expected[i].rgb);
      size += glm::dot(expected[i].rgb, expected[i].rgb);
    }
    EXPECT_LT(std::sqrt(error / size), 2e-4);
    EXPECT_GT(size, 0);
  }
}

TEST(BlockProduct, SameBitsForAnyNumberOfThreadsAndEveryProcessor) {
  for (const MadeMatrix& want : matrices()) {
    SCOPED_TRACE(testing::Message() << want.rows << " x " << want.columns << ", " << want.bits << " bits");
    const codec::BlockMatrix m = madeMatrix(want);
    BlockProduct best(m), plain(m, plainKernels());
    const auto x = randomIrradiance(m.columns);
    const auto expected = product(plain, x);
    for (const ProductKernels* kernels : kernelsHere()) {
      BlockProduct of(m, *kernels);
      EXPECT_EQ(product(of, x), expected);
    }
    for (const int threads : {1, 2, 3}) {
      const ThreadLimit limit(threads);
      EXPECT_EQ(product(best, x), expected) << threads;
    }
  }
}

TEST(BlockProduct, DependsOnNothingFromBefore) {
  for (const MadeMatrix& want : matrices()) {
    const codec::BlockMatrix m = madeMatrix(want);
    BlockProduct fresh(m), used(m);
    const auto x = randomIrradiance(m.columns, 1);
    auto dark = x;
    for (std::size_t j = m.cluster_first[0]; j < m.cluster_first[1]; ++j) dark[m.cluster_column[j]] = {};
    product(used, randomIrradiance(m.columns, 2));
    product(used, std::vector<Irradiance>(m.columns));
    product(used, dark);
    EXPECT_EQ(product(used, x), product(fresh, x));
    EXPECT_EQ(product(used, dark), product(fresh, dark));
  }
}

// Leaving out dark clusters gives what taking them along gives: a colour of which every cluster has a little
// keeps them lit.
TEST(BlockProduct, DarkClustersChangeNoBit) {
  const codec::BlockMatrix m =
      madeMatrix({.rows = 700, .columns = 333, .tiles = 2, .clusters = 7, .rank = 90, .overlap = 40});
  BlockProduct p(m);
  auto x = randomIrradiance(m.columns);
  for (std::size_t c = 0; c < m.clusters(); c += 2)
    for (std::size_t j = m.cluster_first[c]; j < m.cluster_first[c + 1]; ++j) x[m.cluster_column[j]] = {};
  for (Irradiance& e : x) e.rgb.b = 0;
  const auto skipped = product(p, x);
  for (std::size_t c = 0; c < m.clusters(); ++c) x[m.cluster_column[m.cluster_first[c]]].rgb.b = 1;
  const auto taken = product(p, x);
  for (std::size_t i = 0; i < m.rows; ++i) {
    EXPECT_EQ(skipped[i].rgb.r, taken[i].rgb.r);
    EXPECT_EQ(skipped[i].rgb.g, taken[i].rgb.g);
  }
}

TEST(BlockProduct, DarknessIsDark) {
  const codec::BlockMatrix m = madeMatrix({});
  BlockProduct p(m);
  product(p, randomIrradiance(m.columns));
  EXPECT_EQ(product(p, std::vector<Irradiance>(m.columns)), std::vector<Irradiance>(m.rows));
  // So dark that no step can tell: dark, not a division by zero.
  EXPECT_EQ(product(p, std::vector<Irradiance>(m.columns, Irradiance(1e-40f))),
            std::vector<Irradiance>(m.rows));
}

TEST(BlockProduct, TheBrightestLightStaysFinite) {
  for (const std::uint32_t bits : {8u, 16u}) {
    const codec::BlockMatrix m = madeMatrix({.columns = 600, .bits = bits, .rank = 100});
    BlockProduct p(m);
    for (const Irradiance& e :
         product(p, std::vector<Irradiance>(m.columns, Irradiance(BlockProduct::kLargest))))
      EXPECT_TRUE(isFinite(e.rgb));
  }
}

TEST(BlockProduct, RefusesScalesThatLeaveTheRange) {
  codec::BlockMatrix m = madeMatrix({});
  m.scale[3] = 1e30f;
  EXPECT_THROW(BlockProduct{m}, Error);
}

}  // namespace
}  // namespace relume::relight
