// SPDX-License-Identifier: MIT
#include "relume/basis/sh9.h"

#include <gtest/gtest.h>

#include <cmath>

#include "relume/core/sampling.h"

namespace relume::basis {
namespace {

constexpr std::uint32_t kDirections = 1 << 14;  // a net: integrals of smooth functions to 1e-3 and better

TEST(Sh9, IsOrthonormal) {
  std::array<std::array<double, kSh9>, kSh9> product{};
  for (std::uint32_t i = 0; i < kDirections; ++i) {
    const auto y = sh9(squareToSphere(sobol2(i, 1)));
    double squares = 0;
    for (std::size_t a = 0; a < kSh9; ++a) {
      squares += static_cast<double>(y[a] * y[a]);
      for (std::size_t b = 0; b < kSh9; ++b)
        product[a][b] += static_cast<double>(y[a] * y[b]) * 4 * M_PI / kDirections;
    }
    ASSERT_NEAR(squares, 9 / (4 * M_PI), 1e-5);
  }
  for (std::size_t a = 0; a < kSh9; ++a)
    for (std::size_t b = 0; b < kSh9; ++b) EXPECT_NEAR(product[a][b], a == b ? 1 : 0, 3e-3) << a << " " << b;
}

TEST(Sh9, OrderIsThatOfTheBands) {
  const float r = std::sqrt(0.5f);
  EXPECT_GT(sh9({0, 1, 0})[1], 0.48f);
  EXPECT_GT(sh9({0, 0, 1})[2], 0.48f);
  EXPECT_GT(sh9({1, 0, 0})[3], 0.48f);
  EXPECT_GT(sh9({r, r, 0})[4], 0.54f);
  EXPECT_GT(sh9({0, r, r})[5], 0.54f);
  EXPECT_GT(sh9({0, 0, 1})[6], 0.63f);
  EXPECT_GT(sh9({r, 0, r})[7], 0.54f);
  EXPECT_GT(sh9({1, 0, 0})[8], 0.54f);
}

/// Irradiance along n of a radiance, projected.
template <class Radiance>
double irradiance(const Radiance& radiance, Direction n) {
  std::array<double, kSh9> c{};
  for (std::uint32_t i = 0; i < kDirections; ++i) {
    const Direction d = squareToSphere(sobol2(i, 2));
    const auto y = sh9(d);
    for (std::size_t k = 0; k < kSh9; ++k)
      c[k] += radiance(d) * static_cast<double>(y[k]) * 4 * M_PI / kDirections;
  }
  const auto y = sh9(n);
  double e = 0;
  for (std::size_t k = 0; k < kSh9; ++k)
    e += static_cast<double>(kCosineLobe[k]) * c[k] * static_cast<double>(y[k]);
  return e;
}

TEST(Sh9, HoldsIrradiance) {
  const Direction n = glm::normalize(Vec3(1, 2, -3));
  EXPECT_NEAR(irradiance([](Direction) { return 1.0; }, n), M_PI, 1e-3);
  // L = 1 + d.z: E = pi + 2 pi / 3 n.z. A sky above and nothing below: pi (1 + n.z) / 2, no band 2 in it.
  EXPECT_NEAR(irradiance([](Direction d) { return 1.0 + static_cast<double>(d.z); }, n),
              M_PI + 2 * M_PI / 3 * static_cast<double>(n.z), 5e-3);
  EXPECT_NEAR(irradiance([](Direction d) { return d.z > 0 ? 1.0 : 0.0; }, n),
              M_PI * (1 + static_cast<double>(n.z)) / 2, 1e-2);
}

}  // namespace
}  // namespace relume::basis
