// SPDX-License-Identifier: MIT
#include "exposure.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "relume/core/quantity.h"

namespace relume::app {
namespace {

constexpr float kTooBright = 2.0f;  // median luminance that the tone curve shows as nearly white
constexpr float kTooDark = 0.2f;    // and the one below which most of the picture looks black
constexpr float kMiddle =
    0.3f;  // where the median goes then: sunlit places, some ten times brighter, still differ
constexpr float kMostStops = 20.0f;

}  // namespace

float chooseExposure(const image::Image& linear, Vec3 background, bool raise) {
  std::vector<float> seen;
  for (std::size_t i = 0; i < linear.pixels(); ++i) {
    const Vec3 rgb(linear.data[3 * i], linear.data[3 * i + 1], linear.data[3 * i + 2]);
    if (rgb != background && rgb != Vec3(0.0f)) seen.push_back(luminance(rgb));
  }
  if (seen.empty()) return 0.0f;
  const auto middle = seen.begin() + static_cast<std::ptrdiff_t>(seen.size() / 2);
  std::nth_element(seen.begin(), middle, seen.end());
  if (*middle > kTooBright || (raise && *middle < kTooDark))
    return std::min(std::log2(kMiddle / *middle), kMostStops);
  return 0.0f;
}

}  // namespace relume::app
