// SPDX-License-Identifier: MIT
#include "relume/codec/time_series.h"

#include <gtest/gtest.h>

#include <cmath>

namespace relume::codec {
namespace {

constexpr std::size_t kFrames = 30, kValues = 5000;

/// Frames made of three images that come and go.
std::vector<float> threeImages() {
  std::vector<float> data(kFrames * kValues);
  for (std::size_t k = 0; k < kFrames; ++k)
    for (std::size_t i = 0; i < kValues; ++i) {
      const float x = static_cast<float>(i) / kValues, t = static_cast<float>(k) / kFrames;
      data[k * kValues + i] =
          2 + std::sin(9 * x) * std::cos(3 * t) + 0.3f * x * t * t + 0.02f * std::cos(50 * x) * t;
    }
  return data;
}

double worst(const TimeSeries& series, const std::vector<float>& data) {
  std::vector<float> out(kValues);
  double most = 0;
  for (std::size_t k = 0; k < kFrames; ++k) {
    series.frame(k, out);
    for (std::size_t i = 0; i < kValues; ++i)
      most = std::max(most, static_cast<double>(std::abs(out[i] - data[k * kValues + i])));
  }
  return most;
}

// Half a step for each image and the mean's own rounding (half floats); nothing else is lost with as many
// images as there are.
TEST(TimeSeries, IsExactToItsSteps) {
  const std::vector<float> data = threeImages();
  const Pca pca = codec::pca(data, kFrames, kValues, {.rank = 8});
  EXPECT_LT(pca.error(3), 1e-9 * pca.error(0)) << "made of three images";
  for (const float step : {0.0f, 0.01f, 0.05f}) {
    const TimeSeries series = encodeTimeSeries(pca, 3, step);
    double allowed = 2.0 * 0x1p-10 + 1e-5;  // the mean is below 4
    for (const float s : series.step) allowed += 0.5 * static_cast<double>(s);
    const double off = worst(series, data);
    EXPECT_LE(off, allowed) << step;
    if (step > 0) {
      EXPECT_GT(off, 0.2 * static_cast<double>(step));
    }
    for (const float w : series.weights) EXPECT_LE(std::abs(w), 1.0f);
  }
  EXPECT_GT(worst(encodeTimeSeries(pca, 1, 0), data), 5 * worst(encodeTimeSeries(pca, 3, 0), data));
}

TEST(TimeSeries, ImagesThatMatterLittleHoldSmallNumbers) {
  const Pca pca = codec::pca(threeImages(), kFrames, kValues, {.rank = 3});
  const TimeSeries series = encodeTimeSeries(pca, 3, 0.01f);
  int most = 0;
  for (std::size_t i = 0; i < kValues; ++i)
    most = std::max(most, std::abs(static_cast<int>(series.images[2 * kValues + i])));
  EXPECT_LE(most, 3);
}

TEST(TimeSeries, BlendsAreLinear) {
  const std::vector<float> data = threeImages();
  const TimeSeries series = encodeTimeSeries(codec::pca(data, kFrames, kValues, {.rank = 3}), 3, 0);
  std::vector<float> gains(kFrames, 0.0f), a(kValues), b(kValues), both(kValues);
  series.frame(4, a), series.frame(21, b);
  gains[4] = 0.25f, gains[21] = 3;
  series.blend(gains, both);
  for (std::size_t i = 0; i < kValues; ++i) EXPECT_NEAR(both[i], 0.25f * a[i] + 3 * b[i], 1e-4f);
}

TEST(TimeSeries, OneFrameIsItsMean) {
  const std::vector<float> data(10, 0.7f);
  const TimeSeries series = encodeTimeSeries(codec::pca(data, 1, 10, {.rank = 4}), 0, 0.1f);
  std::vector<float> out(10);
  series.frame(0, out);
  for (const float v : out) EXPECT_NEAR(v, 0.7f, 0.7f * 0x1p-11f);
}

}  // namespace
}  // namespace relume::codec
