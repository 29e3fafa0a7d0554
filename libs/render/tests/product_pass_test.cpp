// SPDX-License-Identifier: MIT
// The product on the device against the plain one, codec::multiply.
#include "product_pass.h"

#include <cmath>
#include <random>

#include "gl_test.h"
#include "made_bake.h"

namespace relume::render {
namespace {

struct Product : GlTest, testing::WithParamInterface<relight::MadeMatrix> {};

std::vector<Irradiance> randomEntries(std::size_t count) {
  std::mt19937 random(3);
  std::uniform_real_distribution<float> unit;
  std::vector<Irradiance> x;
  for (std::size_t i = 0; i < count; ++i) x.emplace_back(Vec3(unit(random), 3 * unit(random), unit(random)));
  return x;
}

void expectPlainProduct(const codec::BlockMatrix& m, ProductPass& pass, std::span<const Irradiance> x) {
  pass.write(x);
  pass.multiply();
  const std::vector<Irradiance> got = pass.readExits();
  double error = 0, norm = 0;
  for (int c = 0; c < 3; ++c) {
    // The plain product has as many channels as the matrix.
    std::vector<float> in(m.columns * m.channels), out(m.rows * m.channels);
    const auto channel = m.channels == 3 ? static_cast<std::size_t>(c) : 0;
    for (std::size_t j = 0; j < m.columns; ++j) in[j * m.channels + channel] = x[j].rgb[c];
    codec::multiply(m, in, out);
    for (std::size_t i = 0; i < m.rows; ++i) {
      const double expected = out[i * m.channels + channel];
      error += std::pow(got[i].rgb[c] - expected, 2), norm += expected * expected;
    }
  }
  ASSERT_GT(norm, 0);
  EXPECT_LT(std::sqrt(error / norm), 2e-6);  // floats beside doubles
}

TEST_P(Product, IsThatOfTheCodec) {
  const codec::BlockMatrix m = relight::madeMatrix(GetParam());
  ProductPass pass(m);
  std::vector<Irradiance> x = randomEntries(m.columns);
  expectPlainProduct(m, pass, x);
  // Clusters that become dark leave nothing behind, and come back.
  for (std::size_t j = m.cluster_first[0]; j < m.cluster_first[1]; ++j)
    x[m.cluster_column[j]] = Irradiance(0.0f);
  expectPlainProduct(m, pass, x);
  expectPlainProduct(m, pass, randomEntries(m.columns));
}

INSTANTIATE_TEST_SUITE_P(
    Matrices, Product,
    testing::Values(relight::MadeMatrix{}, relight::MadeMatrix{.channels = 1},
                    relight::MadeMatrix{.bits = 16},
                    relight::MadeMatrix{.columns = 37, .channels = 1, .bits = 16, .clusters = 5},
                    // Clustered PCA: one tile that holds all rows.
                    relight::MadeMatrix{.rows = 1001, .columns = 70, .tiles = 1, .clusters = 6},
                    relight::MadeMatrix{.rows = 3000, .columns = 200, .tiles = 40, .clusters = 7}));

}  // namespace
}  // namespace relume::render
