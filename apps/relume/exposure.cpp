// SPDX-License-Identifier: MIT
#include "exposure.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "relume/core/quantity.h"

namespace relume::app {
namespace {

constexpr float kTooBright = 2.0f;  // median luminance that the tone curve shows as nearly white
constexpr float kMiddle =
    0.3f;  // where the median goes then: sunlit places, some ten times brighter, still differ

}  // namespace

float chooseExposure(const image::Image& linear, Vec3 background) {
  std::vector<float> seen;
  for (std::size_t i = 0; i < linear.pixels(); ++i) {
    const Vec3 rgb(linear.data[3 * i], linear.data[3 * i + 1], linear.data[3 * i + 2]);
    if (rgb != background) seen.push_back(luminance(rgb));
  }
  if (seen.empty()) return 0.0f;
  const auto middle = seen.begin() + static_cast<std::ptrdiff_t>(seen.size() / 2);
  std::nth_element(seen.begin(), middle, seen.end());
  return *middle > kTooBright ? std::log2(kMiddle / *middle) : 0.0f;
}

}  // namespace relume::app
