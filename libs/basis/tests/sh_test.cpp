// SPDX-License-Identifier: MIT
#include "relume/basis/sh.h"

#include <gtest/gtest.h>

#include <cmath>

#include "relume/basis/h_basis.h"
#include "relume/basis/sh9.h"
#include "skies.h"

namespace relume::basis {
namespace {

TEST(Sh, IsOrthonormalToTheFourthBand) {
  std::array<std::array<double, kShMost>, kShMost> product{};
  std::array<float, kShMost> y;
  for (const Direction d : sky::net()) {
    shValues(d, y);
    for (std::size_t a = 0; a < kShMost; ++a)
      for (std::size_t b = 0; b < kShMost; ++b)
        product[a][b] += static_cast<double>(y[a]) * static_cast<double>(y[b]) * sky::netWeight();
  }
  for (std::size_t a = 0; a < kShMost; ++a)
    for (std::size_t b = 0; b < kShMost; ++b)
      EXPECT_NEAR(product[a][b], a == b ? 1 : 0, 1e-3) << a << " " << b;
}

TEST(Sh, BeginsAsTheShortOneDoes) {
  const Direction d = glm::normalize(Vec3(0.3f, -0.5f, 0.7f));
  std::array<float, kSh9> y;
  shValues(d, y);
  const auto expected = sh9(d);
  for (std::size_t i = 0; i < kSh9; ++i) EXPECT_NEAR(y[i], expected[i], 1e-6f) << i;
}

TEST(Sh, SignsOfCondonAndShortleyTurnOddOrders) {
  constexpr std::array<float, 9> kExpected = {1, -1, 1, -1, 1, -1, 1, -1, 1};
  for (std::size_t i = 0; i < kExpected.size(); ++i) EXPECT_EQ(condonShortley(i), kExpected[i]) << i;
  EXPECT_EQ(condonShortley(9), -1.0f);  // l = 3, m = -3
  EXPECT_EQ(condonShortley(12), 1.0f);
}

/// A_l = 2 pi times the integral from 0 to 1 of t P_l(t).
TEST(Sh, CosineFactorsAreTheIntegrals) {
  constexpr int kSteps = 20000;
  for (std::size_t l = 0; l < kCosineFactor.size(); ++l) {
    double sum = 0;
    for (int i = 0; i < kSteps; ++i) {
      const double t = (i + 0.5) / kSteps;
      sum += t * std::legendre(static_cast<unsigned>(l), t) / kSteps;
    }
    EXPECT_NEAR(static_cast<double>(kCosineFactor[l]), 2 * M_PI * sum, 1e-6) << l;
  }
}

TEST(HBasis, IsOrthonormalOverTheHemisphere) {
  std::array<std::array<double, kHMost>, kHMost> product{};
  for (const Direction d : sky::net()) {
    if (d.z < 0) continue;
    const auto h = hValues(d);
    for (std::size_t a = 0; a < kHMost; ++a)
      for (std::size_t b = 0; b < kHMost; ++b)
        product[a][b] += static_cast<double>(h[a]) * static_cast<double>(h[b]) * sky::netWeight();
  }
  for (std::size_t a = 0; a < kHMost; ++a)
    for (std::size_t b = 0; b < kHMost; ++b)
      EXPECT_NEAR(product[a][b], a == b ? 1 : 0, 2e-3) << a << " " << b;
}

/// The factors as quadrature finds them: a copy that divides by the square roots instead fails.
TEST(HBasis, FromShIsTheProjection) {
  for (std::size_t k = 0; k < kSh9; ++k) {
    std::array<float, kSh9> sh{}, y;
    sh[k] = 1.0f;
    std::array<double, kHMost> expected{};
    for (const Direction d : sky::net()) {
      if (d.z < 0) continue;
      shValues(d, y);
      const auto h = hValues(d);
      for (std::size_t i = 0; i < kHMost; ++i)
        expected[i] += static_cast<double>(h[i]) * static_cast<double>(y[k]) * sky::netWeight();
    }
    const auto h = hFromSh(sh);
    for (std::size_t i = 0; i < kHMost; ++i)
      EXPECT_NEAR(static_cast<double>(h[i]), expected[i], 1e-3) << k << " " << i;
  }
}

}  // namespace
}  // namespace relume::basis
