// SPDX-License-Identifier: MIT
#include "report_numbers.h"

#include <algorithm>
#include <cmath>

#include "relume/core/check.h"

namespace relume::bake {

Histogram histogramOf(std::span<const double> values, std::vector<double> edges) {
  RELUME_CHECK_LE(std::size_t{2}, edges.size());
  Histogram result{.edges = std::move(edges), .counts = {}};
  result.counts.resize(result.edges.size() - 1);
  for (const double value : values) {
    const auto above = std::upper_bound(result.edges.begin(), result.edges.end(), value);
    const auto bin = std::clamp<std::ptrdiff_t>(above - result.edges.begin() - 1, 0,
                                                static_cast<std::ptrdiff_t>(result.counts.size()) - 1);
    ++result.counts[static_cast<std::size_t>(bin)];
  }
  return result;
}

double quantile(std::span<double> values, double share) {
  if (values.empty()) return 0;
  const auto rank =
      std::min(static_cast<std::size_t>(share * static_cast<double>(values.size())), values.size() - 1);
  const auto at = values.begin() + static_cast<std::ptrdiff_t>(rank);
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

SeamError seamError(std::span<const atlas::SeamSample> seams, int channels, std::span<const float> values) {
  const auto stride = static_cast<std::size_t>(channels);
  SeamError result{.samples = seams.size()};
  double sum = 0;
  for (const atlas::SeamSample& seam : seams) {
    for (std::size_t c = 0; c < stride; ++c) {
      double side[2] = {0, 0};
      for (int s = 0; s < 2; ++s)
        for (int k = 0; k < 4; ++k)
          side[s] += static_cast<double>(seam.weight[s][k]) * values[seam.texel[s][k] * stride + c];
      const double difference = std::abs(side[0] - side[1]);
      sum += difference * difference;
      result.max = std::max(result.max, difference);
    }
  }
  if (!seams.empty()) result.rms = std::sqrt(sum / static_cast<double>(seams.size() * stride));
  return result;
}

double texelDensity(const atlas::SurfacePoint& point) {
  const double square = glm::length(glm::cross(point.dp_dx, point.dp_dy));  // m^2 of a whole texel
  return square > 0 ? 1 / std::sqrt(square) : 0;
}

std::vector<ChartError> chartErrors(const atlas::Texels& texels, const PointLayer& layer,
                                    std::size_t charts) {
  std::vector<ChartError> result(charts);
  std::vector<std::size_t> counts(charts);
  const PointPlane& plane = layer.planes.front();
  const auto channels = static_cast<std::size_t>(plane.channels);
  for (std::size_t i = 0; i < texels.points.size(); ++i) {
    if (!layer.valid[i]) continue;
    const std::size_t chart = texels.points[i].chart;
    const double error = layer.error[i];
    result[chart].rms += error * error;
    result[chart].max = std::max(result[chart].max, error);
    for (std::size_t c = 0; c < channels; ++c)
      result[chart].mean_value += plane.values[i * channels + c] / static_cast<double>(channels);
    ++counts[chart];
  }
  for (std::size_t c = 0; c < charts; ++c) {
    if (counts[c] == 0) continue;
    result[c].rms = std::sqrt(result[c].rms / static_cast<double>(counts[c]));
    result[c].mean_value /= static_cast<double>(counts[c]);
  }
  return result;
}

}  // namespace relume::bake
