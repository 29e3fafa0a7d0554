// SPDX-License-Identifier: MIT
#include "relume/codec/time_series.h"

#include <algorithm>
#include <cmath>

#include "relume/codec/quantize.h"
#include "relume/core/check.h"
#include "relume/core/parallel.h"

namespace relume::codec {
namespace {

constexpr float kMostWord = 32767.0f;
constexpr std::size_t kBlock = 4096;  // values summed at a time

}  // namespace

TimeSeries encodeTimeSeries(const Pca& pca, std::size_t rank, float step) {
  RELUME_CHECK_LE(rank, pca.rank);
  TimeSeries series{.frames = pca.rows, .values = pca.columns, .rank = rank};
  float most_mean = 0;
  for (const float v : pca.mean) most_mean = std::max(most_mean, std::abs(v));
  series.mean_scale = std::max(most_mean / kHalfMax, 1.0f);
  for (const float v : pca.mean) series.mean.push_back(halfFromFloat(v / series.mean_scale));
  series.images.resize(rank * series.values), series.weights.resize(pca.rows * rank);
  for (std::size_t c = 0; c < rank; ++c) {
    float most_weight = 0, most_value = 0;
    for (std::size_t k = 0; k < pca.rows; ++k)
      most_weight = std::max(most_weight, std::abs(pca.weights[k * pca.rank + c]));
    const float* component = &pca.components[c * pca.columns];
    for (std::size_t i = 0; i < series.values; ++i)
      most_value = std::max(most_value, most_weight * std::abs(component[i]));
    const float own = std::max({step, most_value / kMostWord, 1e-30f});
    series.step.push_back(own);
    for (std::size_t i = 0; i < series.values; ++i)
      series.images[c * series.values + i] = static_cast<std::int16_t>(
          std::clamp(std::round(most_weight * component[i] / own), -kMostWord, kMostWord));
    for (std::size_t k = 0; k < pca.rows; ++k)
      series.weights[k * rank + c] = most_weight > 0 ? pca.weights[k * pca.rank + c] / most_weight : 0.0f;
  }
  return series;
}

void TimeSeries::blend(std::span<const float> gains, std::span<float> out) const {
  RELUME_CHECK_EQ(gains.size(), frames);
  RELUME_CHECK_EQ(out.size(), values);
  float all = 0;
  std::vector<float> factor(rank, 0.0f);
  for (std::size_t k = 0; k < frames; ++k) {
    if (gains[k] == 0) continue;
    all += gains[k];
    for (std::size_t c = 0; c < rank; ++c) factor[c] += gains[k] * weights[k * rank + c] * step[c];
  }
  parallelFor(values, kBlock, [&](std::size_t begin, std::size_t end) {
    const float scale = all * mean_scale;
    for (std::size_t i = begin; i < end; ++i) out[i] = scale * floatFromHalf(mean[i]);
    for (std::size_t c = 0; c < rank; ++c) {
      const float f = factor[c];
      const std::int16_t* image = images.data() + c * values;
      if (f != 0)
        for (std::size_t i = begin; i < end; ++i) out[i] += f * static_cast<float>(image[i]);
    }
  });
}

void TimeSeries::frame(std::size_t index, std::span<float> out) const {
  std::vector<float> gains(frames, 0.0f);
  gains[index] = 1;
  blend(gains, out);
}

}  // namespace relume::codec
