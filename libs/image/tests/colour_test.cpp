// SPDX-License-Identifier: MIT
#include "relume/image/colour.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace relume::image {
namespace {

// CIE L*a*b*, not the space in which the maps are laid out.
Vec3 lab(Vec3 rgb) {
  const auto f = [](float t) {
    return t > 216.0f / 24389.0f ? std::cbrt(t) : 841.0f / 108.0f * t + 4.0f / 29.0f;
  };
  const float x = f(glm::dot(rgb, Vec3(0.4124f, 0.3576f, 0.1805f)) / 0.9505f);
  const float y = f(glm::dot(rgb, Vec3(0.2126f, 0.7152f, 0.0722f)));
  const float z = f(glm::dot(rgb, Vec3(0.0193f, 0.1192f, 0.9505f)) / 1.089f);
  return {116 * y - 16, 500 * (x - y), 200 * (y - z)};
}

bool displayable(Vec3 c) {
  return glm::all(glm::greaterThanEqual(c, Vec3(0))) && glm::all(glm::lessThanEqual(c, Vec3(1)));
}

TEST(ToneMap, PlainClampsAndFilmicRollsOff) {
  Image image(5, 1, 1);
  image.data = {-1.0f, 0.25f, 11.2f, 1e30f, std::numeric_limits<float>::quiet_NaN()};
  const Image plain = toneMap(image, ToneCurve::kPlain), filmic = toneMap(image, ToneCurve::kFilmic);
  EXPECT_EQ(plain.data, (std::vector<float>{0.0f, 0.25f, 1.0f, 1.0f, 0.0f}));
  EXPECT_EQ(filmic.data[0], 0.0f);
  EXPECT_NEAR(filmic.data[2], 1.0f, 1e-6f);
  EXPECT_EQ(filmic.data[3], 1.0f);
  EXPECT_EQ(filmic.data[4], 0.0f);
  // By hand: h(x) = (x (0.15 x + 0.05) + 0.004) / (x (0.15 x + 0.5) + 0.06) - 1/15.
  const auto h = [](double x) {
    return (x * (0.15 * x + 0.05) + 0.004) / (x * (0.15 * x + 0.5) + 0.06) - 1.0 / 15.0;
  };
  EXPECT_NEAR(filmic.data[1], h(0.25) / h(11.2), 1e-6);
}

TEST(ToneMap, StopsDoubleAndAlphaStays) {
  Image image(1, 1, 4);
  image.data = {0.1f, 0.2f, 0.05f, 0.5f};
  EXPECT_EQ(toneMap(image, ToneCurve::kPlain, 2.0f).data, (std::vector<float>{0.4f, 0.8f, 0.2f, 0.5f}));
}

TEST(FalseColour, RunsEvenlyFromDarkToBright) {
  const int steps = 64;
  float least = 1e9f, most = 0.0f;
  for (int i = 0; i < steps; ++i) {
    const Vec3 a = falseColour(static_cast<float>(i) / steps),
               b = falseColour(static_cast<float>(i + 1) / steps);
    ASSERT_TRUE(displayable(a));
    EXPECT_GT(lab(b).x, lab(a).x) << "lightness rises at step " << i;
    least = std::min(least, glm::length(lab(b) - lab(a)));
    most = std::max(most, glm::length(lab(b) - lab(a)));
  }
  EXPECT_LT(most, 2.0f * least) << "no part of the scale hides or shouts";
  EXPECT_LT(lab(falseColour(0.0f)).x, 5.0f);
  EXPECT_GT(lab(falseColour(1.0f)).x, 93.0f);
  EXPECT_EQ(falseColour(-3.0f), falseColour(0.0f));
  EXPECT_EQ(falseColour(3.0f), falseColour(1.0f));
  EXPECT_EQ(falseColour(std::numeric_limits<float>::quiet_NaN()), falseColour(0.0f));
}

TEST(FalseColour, ImageUsesItsRange) {
  Image values(3, 1, 1);
  values.data = {2.0f, 3.0f, 4.0f};
  const Image shown = falseColour(values, 2.0f, 4.0f);
  EXPECT_EQ(shown.rgb(0, 0), falseColour(0.0f));
  EXPECT_EQ(shown.rgb(1, 0), falseColour(0.5f));
  EXPECT_EQ(shown.rgb(2, 0), falseColour(1.0f));
  EXPECT_EQ(falseColour(values, 3.0f, 3.0f).rgb(0, 0), falseColour(0.0f)) << "an empty range is not an error";
}

TEST(LabelColour, NeighboursAreToldApart) {
  for (std::uint32_t label = 0; label < 3000; ++label) {
    ASSERT_TRUE(displayable(labelColour(label)));
    for (std::uint32_t k = 1; k <= 12; ++k)
      ASSERT_GT(glm::length(lab(labelColour(label)) - lab(labelColour(label + k))), 20.0f)
          << label << " and " << label + k;
  }
  EXPECT_TRUE(displayable(labelColour(0xffffffffu)));
}

}  // namespace
}  // namespace relume::image
