// SPDX-License-Identifier: MIT
#include "relume/codec/pca.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace relume::codec {
namespace {

constexpr std::size_t kRows = 8, kColumns = 6;
const std::vector<float> kTransfer = {10, 17, 13, -1, 4,  6, 4,  21, 11, 10, 25, 3,  8,  29, 14, 0,
                                      13, 5,  12, 19, 14, 8, -6, 21, 6,  24, 12, 3,  7,  12, 11, 4,
                                      8,  22, 12, 13, 9,  9, 9,  11, 12, 10, 10, 11, 11, 3,  8,  10};

double squaredError(const Pca& p, std::span<const float> data) {
  double sum = 0;
  std::vector<float> row(p.columns);
  for (std::size_t i = 0; i < p.rows; ++i) {
    p.reconstruct(i, row);
    for (std::size_t c = 0; c < p.columns; ++c) {
      const double d = static_cast<double>(row[c]) - data[i * p.columns + c];
      sum += d * d;
    }
  }
  return sum;
}

void expectOrthonormal(const Pca& p, double tolerance) {
  for (std::size_t a = 0; a < p.rank; ++a)
    for (std::size_t b = 0; b <= a; ++b) {
      double dot = 0;
      for (std::size_t c = 0; c < p.columns; ++c)
        dot += static_cast<double>(p.components[a * p.columns + c]) * p.components[b * p.columns + c];
      EXPECT_NEAR(dot, a == b, tolerance) << a << ' ' << b;
    }
}

// Errors found with an independent eigensolver in multiple precision.
TEST(Pca, ReachesTheOptimalErrorOfEveryRank) {
  const double expected[] = {
      1728.875, 920.9896725795, 178.9823040899, 24.7202319790, 6.5045807055, 1.4666752687, 0.0};
  for (std::size_t rank = 0; rank <= kColumns; ++rank) {
    const Pca p = pca(kTransfer, kRows, kColumns, {.rank = rank});
    EXPECT_EQ(p.rank, rank);
    EXPECT_NEAR(p.error(rank), expected[rank], 1e-8);
    EXPECT_NEAR(squaredError(p, kTransfer), expected[rank], 1e-3);
    expectOrthonormal(p, 1e-6);
  }
}

TEST(Pca, WithoutRemovingTheMean) {
  const double expected[] = {
      7539, 1587.7122233604, 820.5685367302, 87.6270419631, 17.7187063355, 1.7187206631, 0.0};
  for (std::size_t rank = 0; rank <= kColumns; ++rank) {
    const Pca p = pca(kTransfer, kRows, kColumns, {.rank = rank, .remove_mean = false});
    EXPECT_NEAR(p.error(rank), expected[rank], 1e-8);
    EXPECT_NEAR(squaredError(p, kTransfer), expected[rank], 1e-3);
    for (const float m : p.mean) EXPECT_EQ(m, 0);
  }
}

TEST(Pca, SingularValues) {
  const double expected[] = {28.423323651898, 27.239812196298, 12.420228343749,
                             4.267979764891,  2.244527887290,  1.211063693078};
  const Pca p = pca(kTransfer, kRows, kColumns);
  ASSERT_EQ(p.variance.size(), 6u);
  for (std::size_t k = 0; k < 6; ++k) EXPECT_NEAR(std::sqrt(p.variance[k]), expected[k], 1e-9);
}

// Rows 0-3 and 4-7 as clusters: fewer rows than columns, so the other Gram matrix is used. The last check is
// what relighting does with it: I = sum_c (sum_e I_e) M_c + sum_c sum_d (sum_e I_e w_de) B_dc.
TEST(Pca, Clusters) {
  const double expected[2][5] = {{943.5, 210.7718452630, 69.7256094110, 0, 0},
                                 {512.25, 68.2477338006, 6.5904914686, 0, 0}};
  const double irradiance[] = {164.46472228931674, 251.66729821383115, 194.9547682316683,
                               148.73463293767082, 161.54080923320413, 196.82959631405964};
  double total = 0;
  std::vector<double> lit(kColumns);
  for (std::size_t c = 0; c < 2; ++c) {
    const auto rows = std::span(kTransfer).subspan(c * 4 * kColumns, 4 * kColumns);
    for (std::size_t rank = 0; rank < 5; ++rank)
      EXPECT_NEAR(squaredError(pca(rows, 4, kColumns, {.rank = rank}), rows), expected[c][rank], 1e-3);
    const Pca p = pca(rows, 4, kColumns, {.rank = 2});
    total += p.error(2);
    expectOrthonormal(p, 1e-6);
    std::vector<float> row(kColumns);
    for (std::size_t e = 0; e < 4; ++e) {
      p.reconstruct(e, row);
      for (std::size_t i = 0; i < kColumns; ++i) lit[i] += 0.5 * static_cast<double>(4 * c + e + 1) * row[i];
    }
  }
  EXPECT_NEAR(total, 76.3161008795833, 1e-8);
  for (std::size_t i = 0; i < kColumns; ++i) EXPECT_NEAR(lit[i], irradiance[i], 1e-3);
}

// Components stay orthonormal although their variances span eleven orders of magnitude, and rank stops at
// what the data has.
TEST(Pca, KeepsNoMoreThanTheDataHas) {
  constexpr std::size_t kN = 20, kM = 300;
  std::mt19937 random(7);
  std::normal_distribution<float> normal;
  std::vector<float> data(kN * kM);
  for (int k = 0; k < 5; ++k) {
    std::vector<float> direction(kM), weight(kN);
    for (float& d : direction) d = normal(random);
    for (float& w : weight) w = normal(random);
    const float scale = std::pow(10.0f, -static_cast<float>(k));
    for (std::size_t i = 0; i < kN; ++i)
      for (std::size_t c = 0; c < kM; ++c) data[i * kM + c] += scale * weight[i] * direction[c];
  }
  const Pca p = pca(data, kN, kM, {.rank = 8});
  EXPECT_EQ(p.rank, 5u);
  expectOrthonormal(p, 1e-6);
  EXPECT_EQ(pca(std::vector<float>(kN * kM, 3.0f), kN, kM).rank, 0u);
  EXPECT_EQ(pca({}, 0, 4).rank, 0u);
}

}  // namespace
}  // namespace relume::codec
