// SPDX-License-Identifier: MIT
#include "relume/core/sampling.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "relume/core/frame.h"

namespace relume {
namespace {

// A (0, m, 2)-net in base 2: every elementary interval of area 2^-m holds exactly one of 2^m points. Checked
// for all shapes of the interval, several scrambles and later runs of the sequence; a plain random set fails
// at once.
TEST(Sobol, EveryAlignedRunIsANet) {
  for (const std::uint32_t stream : {0u, 1u, 0xdeadbeefu}) {
    for (int m = 1; m <= 10; ++m) {
      const std::uint32_t n = 1u << m;
      for (const std::uint32_t first : {0u, n, 5 * n}) {
        for (int a = 0; a <= m; ++a) {
          std::vector<int> count(n, 0);
          for (std::uint32_t i = 0; i < n; ++i) {
            const Vec2 u = sobol2(first + i, stream);
            const auto x = static_cast<std::uint32_t>(u.x * static_cast<float>(1u << a));
            const auto y = static_cast<std::uint32_t>(u.y * static_cast<float>(1u << (m - a)));
            ++count[(x << (m - a)) | y];
          }
          ASSERT_TRUE(std::all_of(count.begin(), count.end(), [](int c) { return c == 1; }))
              << "stream " << stream << ", m " << m << ", first " << first << ", split " << a;
        }
      }
    }
  }
}

// Independent scrambles: the mean over streams of the integral's estimate is unbiased. x^2 y over the square
// is 1/6.
TEST(Sobol, ScramblesAreUnbiased) {
  double sum = 0, sum2 = 0;
  const int streams = 4000;
  for (int s = 0; s < streams; ++s) {
    double estimate = 0;
    for (std::uint32_t i = 0; i < 4; ++i) {
      const Vec2 u = sobol2(i, streamOf(7, static_cast<std::uint32_t>(s), 0));
      estimate += static_cast<double>(u.x) * u.x * u.y / 4;
    }
    sum += estimate, sum2 += estimate * estimate;
  }
  const double mean = sum / streams, standard_error = std::sqrt((sum2 / streams - mean * mean) / streams);
  EXPECT_NEAR(mean, 1.0 / 6, 4 * standard_error);  // false alarm 6e-5; the streams are fixed, so it repeats
  EXPECT_LT(standard_error, 0.002);
}

// Chi-square of the cosine hemisphere over 8 x 16 equal-probability cells (sin^2 theta and phi are uniform
// under it).
TEST(Warp, CosineHemispherePassesChiSquare) {
  constexpr int kRings = 8, kSectors = 16;
  std::vector<int> count(kRings * kSectors, 0);
  const int n = 200000;
  for (int i = 0; i < n; ++i) {
    // Independent uniform numbers: chi-square supposes independence, Sobol points would pass too well.
    const auto a = hashCombine(static_cast<std::uint32_t>(i), 11u),
               b = hashCombine(static_cast<std::uint32_t>(i), 12u);
    const Direction d = squareToCosineHemisphere(
        {static_cast<float>(a >> 8) * 0x1p-24f, static_cast<float>(b >> 8) * 0x1p-24f});
    ASSERT_NEAR(glm::length(d), 1.0f, 1e-3f);
    ASSERT_GT(d.z, 0.0f);
    const int ring = std::min(kRings - 1, static_cast<int>((1 - d.z * d.z) * kRings));
    const int sector =
        std::min(kSectors - 1, static_cast<int>((std::atan2(d.y, d.x) / (2 * kPi) + 0.5f) * kSectors));
    ++count[static_cast<std::size_t>(ring * kSectors + sector)];
  }
  const double expected = double(n) / (kRings * kSectors);
  double chi2 = 0;
  for (const int c : count) chi2 += (c - expected) * (c - expected) / expected;
  EXPECT_LT(chi2, 188.0);  // 127 degrees of freedom: false alarm 0.0004
  EXPECT_GT(chi2, 70.0);   // too regular is wrong too
}

TEST(Warp, SphereHasItsMoments) {
  Vec3 mean(0);
  float z2 = 0;
  const std::uint32_t n = 1u << 14;
  for (std::uint32_t i = 0; i < n; ++i) {
    const Direction d = squareToSphere(sobol2(i, 3));
    mean += d / float(n), z2 += d.z * d.z / float(n);
  }
  EXPECT_LT(glm::length(mean), 1e-3f);
  EXPECT_NEAR(z2, 1.0f / 3, 1e-3f);
}

TEST(Frame, IsOrthonormalAndRightHandedEverywhere) {
  for (std::uint32_t i = 0; i < 1000; ++i) {
    const Normal n = squareToSphere(sobol2(i, 5));
    const Frame f = Frame::about(n);
    EXPECT_NEAR(glm::dot(f.t, f.b), 0, 1e-5);
    EXPECT_NEAR(glm::length(glm::cross(f.t, f.b) - n), 0, 1e-5);
  }
  EXPECT_NEAR(glm::length(Frame::about({0, 0, -1}).t), 1, 1e-6);
}

}  // namespace
}  // namespace relume
