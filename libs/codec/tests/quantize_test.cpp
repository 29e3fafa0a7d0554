// SPDX-License-Identifier: MIT
#include "relume/codec/quantize.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace relume::codec {
namespace {

constexpr std::uint16_t kInfiniteHalf = 0x7c00;

// IEEE 754 binary16 by its definition.
double valueOfHalf(std::uint16_t h) {
  const int exponent = (h >> 10) & 0x1f;
  const double fraction = h & 0x3ff;
  const double magnitude = exponent ? std::ldexp(1024 + fraction, exponent - 25) : std::ldexp(fraction, -24);
  return h & 0x8000 ? -magnitude : magnitude;
}

TEST(Half, EveryFiniteValueIsExactAndComesBack) {
  for (std::uint32_t h = 0; h < 0x10000; ++h) {
    const auto half = static_cast<std::uint16_t>(h);
    if ((half & 0x7c00) == 0x7c00) continue;
    ASSERT_EQ(static_cast<double>(floatFromHalf(half)), valueOfHalf(half)) << h;
    ASSERT_EQ(halfFromFloat(floatFromHalf(half)), half) << h;
  }
}

// Between each two neighbours: the midpoint goes to the even one, a float to either side of it to the nearer
// one.
TEST(Half, RoundsToNearestTiesToEven) {
  for (std::uint16_t h = 0; h < kInfiniteHalf - 1; ++h) {
    const auto above = static_cast<std::uint16_t>(h + 1);
    const auto middle = static_cast<float>((valueOfHalf(h) + valueOfHalf(above)) / 2);
    ASSERT_EQ(halfFromFloat(middle), h % 2 ? above : h) << h;
    ASSERT_EQ(halfFromFloat(std::nextafter(middle, 0.0f)), h) << h;
    ASSERT_EQ(halfFromFloat(std::nextafter(middle, 1e9f)), above) << h;
    ASSERT_EQ(halfFromFloat(-middle), 0x8000 | halfFromFloat(middle)) << h;
  }
}

TEST(Half, ErrorStaysWithinTheStatedBound) {
  for (float x = 1e-9f; x < kHalfMax; x *= 1.0009f) {
    const double error = std::abs(static_cast<double>(floatFromHalf(halfFromFloat(x))) - x);
    ASSERT_LE(error, x >= 0x1p-14f ? x * 0x1p-11 : 0x1p-25) << x;
  }
}

TEST(Half, OverflowInfinityAndNan) {
  const float inf = std::numeric_limits<float>::infinity();
  EXPECT_EQ(halfFromFloat(kHalfMax), 0x7bff);
  EXPECT_EQ(halfFromFloat(std::nextafter(65520.0f, 0.0f)), 0x7bff);
  EXPECT_EQ(halfFromFloat(65520.0f), kInfiniteHalf);
  EXPECT_EQ(halfFromFloat(1e30f), kInfiniteHalf);
  EXPECT_EQ(halfFromFloat(-inf), 0xfc00);
  EXPECT_EQ(floatFromHalf(kInfiniteHalf), inf);
  EXPECT_TRUE(std::isnan(floatFromHalf(halfFromFloat(std::numeric_limits<float>::quiet_NaN()))));
  EXPECT_EQ(halfFromFloat(-0.0f), 0x8000);
}

TEST(Unorm, ErrorIsAtMostHalfAStep) {
  const float lo = -3, hi = 5;
  for (int i = 0; i <= 10000; ++i) {
    const float x = lo + (hi - lo) * static_cast<float>(i) / 10000;
    ASSERT_NEAR(floatFromUnorm8(unorm8FromFloat(x, lo, hi), lo, hi), x, (hi - lo) / 510 + 1e-6);
    ASSERT_NEAR(floatFromUnorm16(unorm16FromFloat(x, lo, hi), lo, hi), x, (hi - lo) / 131070 + 1e-6);
  }
}

TEST(Unorm, EndsAreExactAndValuesOutsideAreClamped) {
  EXPECT_EQ(unorm8FromFloat(-9, -3, 5), 0);
  EXPECT_EQ(unorm8FromFloat(9, -3, 5), 255);
  EXPECT_EQ(floatFromUnorm8(0, -3, 5), -3);
  EXPECT_EQ(floatFromUnorm8(255, -3, 5), 5);
  EXPECT_EQ(floatFromUnorm16(65535, 0.1f, 0.7f), 0.7f);
  for (int q = 0; q < 65536; ++q) {
    const auto u = static_cast<std::uint16_t>(q);
    ASSERT_EQ(unorm16FromFloat(floatFromUnorm16(u, 0, 1), 0, 1), u);
  }
}

}  // namespace
}  // namespace relume::codec
