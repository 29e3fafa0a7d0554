// SPDX-License-Identifier: MIT
#include "environment_sampler.h"

#include <algorithm>
#include <cmath>
#include <span>

#include "relume/core/frame.h"
#include "relume/core/sampling.h"

namespace relume::transport {
namespace {

/// Sums of the weights, scaled to end at 1; uniform where they are all zero. Returns the sum.
double accumulate(std::span<const float> weights, std::span<float> cdf) {
  double sum = 0;
  for (const float w : weights) sum += w;
  double running = 0;
  cdf[0] = 0;
  for (std::size_t i = 0; i < weights.size(); ++i) {
    running += sum > 0 ? weights[i] / sum : 1.0 / static_cast<double>(weights.size());
    cdf[i + 1] = static_cast<float>(running);
  }
  cdf[weights.size()] = 1.0f;
  return sum;
}

/// The cell of u and the place in it: cell + fraction.
struct Place {
  int cell;
  float fraction;
};
Place invert(std::span<const float> cdf, float u) {
  const auto above = std::upper_bound(cdf.begin() + 1, cdf.end() - 1, u);
  const auto cell = static_cast<std::size_t>(above - cdf.begin()) - 1;
  const float width = cdf[cell + 1] - cdf[cell];
  return {static_cast<int>(cell), width > 0 ? std::clamp((u - cdf[cell]) / width, 0.0f, 1.0f) : 0.5f};
}

}  // namespace

EnvironmentSampler::EnvironmentSampler(const scene::Environment& environment) : environment_(environment) {
  if (!environment.map) {
    mean_ = luminance(environment.radiance.rgb);
    return;
  }
  const image::Image& map = *environment.map;
  width_ = map.width, height_ = map.height;
  std::vector<float> own(map.pixels());
  for (int y = 0; y < height_; ++y)
    for (int x = 0; x < width_; ++x)
      own[static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) + static_cast<std::size_t>(x)] =
          std::max(luminance(map.rgb(x, y) * environment.radiance.rgb), 0.0f);

  row_cdf_.resize(static_cast<std::size_t>(height_) + 1);
  column_cdf_.resize(static_cast<std::size_t>(height_) * (static_cast<std::size_t>(width_) + 1));
  std::vector<float> weights(static_cast<std::size_t>(width_)), rows(static_cast<std::size_t>(height_));
  double sum = 0, sines = 0;
  const auto at = [&](int x, int y) {
    x = (x + width_) % width_, y = std::clamp(y, 0, height_ - 1);
    return own[static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) + static_cast<std::size_t>(x)];
  };
  for (int y = 0; y < height_; ++y) {
    const float sine = std::sin(kPi * (static_cast<float>(y) + 0.5f) / static_cast<float>(height_));
    for (int x = 0; x < width_; ++x) {
      float around = 0;
      for (int j = -1; j <= 1; ++j)
        for (int i = -1; i <= 1; ++i) around += at(x + i, y + j);
      weights[static_cast<std::size_t>(x)] = 0.5f * at(x, y) + (0.5f / 9.0f) * around;
      sum += sine * at(x, y);
    }
    sines += sine * width_;
    const std::size_t stride = static_cast<std::size_t>(width_) + 1;
    rows[static_cast<std::size_t>(y)] =
        sine * static_cast<float>(accumulate(
                   weights, std::span(column_cdf_).subspan(static_cast<std::size_t>(y) * stride, stride)));
  }
  accumulate(rows, row_cdf_);
  mean_ = static_cast<float>(sum / sines);
}

Direction EnvironmentSampler::sample(Normal n, Vec2 u) const {
  if (!environment_.map)
    return n == Normal(0) ? squareToSphere(u) : Frame::about(n).toWorld(squareToCosineHemisphere(u));
  const Place row = invert(row_cdf_, u.y);
  const std::size_t stride = static_cast<std::size_t>(width_) + 1;
  const Place column =
      invert(std::span(column_cdf_).subspan(static_cast<std::size_t>(row.cell) * stride, stride), u.x);
  return environment_.worldFromMap(scene::directionFromEquirect(
      {(static_cast<float>(column.cell) + column.fraction) / static_cast<float>(width_),
       (static_cast<float>(row.cell) + row.fraction) / static_cast<float>(height_)}));
}

float EnvironmentSampler::pdf(Normal n, Direction d) const {
  if (!environment_.map) return n == Normal(0) ? 0.25f * kInvPi : std::max(glm::dot(n, d), 0.0f) * kInvPi;
  const Direction in_map = environment_.mapFromWorld(d);
  const Vec2 uv = scene::equirectFromDirection(in_map);
  const auto cellOf = [](float t, int count) {
    return static_cast<std::size_t>(
        std::clamp(static_cast<int>(t * static_cast<float>(count)), 0, count - 1));
  };
  const std::size_t x = cellOf(uv.x, width_), y = cellOf(uv.y, height_);
  const float* columns = column_cdf_.data() + y * (static_cast<std::size_t>(width_) + 1);
  const float density = (row_cdf_[y + 1] - row_cdf_[y]) * static_cast<float>(height_) *
                        (columns[x + 1] - columns[x]) * static_cast<float>(width_);
  const float sine = std::sqrt(std::max(0.0f, 1.0f - in_map.y * in_map.y));
  return sine > 0 ? density / (2 * kPi * kPi * sine) : 0.0f;
}

}  // namespace relume::transport
