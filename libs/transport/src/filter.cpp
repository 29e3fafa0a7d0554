// SPDX-License-Identifier: MIT
// Edge-aware smoothing of texel values: a joint bilateral filter. A neighbour's weight is the product of
//   a flat window of 2 radius x 2 radius texels (half weights at its rim),
//   max(0, n_i . n_j)^normal_power, 0 across a crease,
//   a fall-off with its distance from the texel's plane: on a curved chart neighbours bend away, on a stepped
//   one they jump, a fall-off with the difference of the values, measured in their standard errors: what
//   noise explains is mixed.
// A neighbour is used together with its mirror image, and both with the smaller of their weights, so that a
// linear gradient passes unchanged, at the rim of a chart too; a window that renormalises there, or that is
// shifted inside, bends gradients.
#include <algorithm>
#include <cmath>

#include "relume/core/check.h"
#include "relume/core/parallel.h"
#include "relume/transport/occlusion.h"

namespace relume::transport {
namespace {

constexpr float kCreaseCosine = 0.9f;     // 26 degrees between the normals of neighbouring texels
constexpr float kPlaneTolerance = 0.25f;  // of the distance between the texels

float power(float base, int exponent) {
  float result = 1.0f;
  for (; exponent > 0; exponent >>= 1, base *= base)
    if (exponent & 1) result *= base;
  return result;
}

class Filter {
 public:
  Filter(const atlas::Texels& texels, std::span<const float> error, std::span<const std::uint8_t> valid,
         int channels, const FilterOptions& options)
      : texels_(texels),
        error_(error),
        valid_(valid),
        channels_(static_cast<std::size_t>(channels)),
        options_(options),
        width_(texels.width),
        height_(texels.height),
        point_of_(static_cast<std::size_t>(texels.pages) * static_cast<std::size_t>(texels.height) *
                      static_cast<std::size_t>(texels.width),
                  scene::kNone) {
    for (std::size_t i = 0; i < texels.points.size(); ++i) {
      if (usable(i)) point_of_[texels.points[i].texel] = static_cast<std::uint32_t>(i);
    }
  }

  /// The filtered values of point i, and the error that they are left with; in: [points][channels], out:
  /// [channels].
  float apply(std::size_t i, std::span<const float> in, float* out) const {
    std::copy_n(&in[i * channels_], channels_, out);
    if (!usable(i)) return error_[i];
    const int radius = options_.radius;
    const std::uint32_t texel = texels_.points[i].texel;
    const auto x = static_cast<int>(texel % static_cast<std::uint32_t>(width_));
    const auto y =
        static_cast<int>(texel / static_cast<std::uint32_t>(width_) % static_cast<std::uint32_t>(height_));
    const std::uint32_t* centre = &point_of_[texel];
    const int reach_x = std::min({radius, x, width_ - 1 - x}),
              reach_y = std::min({radius, y, height_ - 1 - y});
    float total = 1.0f, variance = error_[i] * error_[i];
    for (int dy = 0; dy <= reach_y; ++dy) {
      for (int dx = dy == 0 ? 1 : -reach_x; dx <= reach_x; ++dx) {
        const std::uint32_t a = centre[dy * width_ + dx], b = centre[-dy * width_ - dx];
        if (a == scene::kNone || b == scene::kNone) continue;
        float weight = std::min(likeness(i, a, in), likeness(i, b, in));
        if (weight > 0.0f) weight *= std::min(geometry(i, a), geometry(i, b));
        if (weight <= 0.0f) continue;
        if (dy == radius) weight *= 0.5f;
        if (dx == radius || dx == -radius) weight *= 0.5f;
        for (std::size_t c = 0; c < channels_; ++c)
          out[c] += weight * (in[a * channels_ + c] + in[b * channels_ + c]);
        total += 2.0f * weight;
        variance += weight * weight * (error_[a] * error_[a] + error_[b] * error_[b]);
      }
    }
    for (std::size_t c = 0; c < channels_; ++c) out[c] /= total;
    return std::sqrt(variance) / total;
  }

 private:
  bool usable(std::size_t i) const { return valid_.empty() || valid_[i] != 0; }

  float geometry(std::size_t i, std::size_t j) const {
    const atlas::SurfacePoint &p = texels_.points[i], &q = texels_.points[j];
    if (p.chart != q.chart) return 0.0f;
    if (p.triangle == q.triangle && p.shading_normal == q.shading_normal) return 1.0f;  // on flat walls most
    const float cosine = glm::dot(p.shading_normal, q.shading_normal);
    if (cosine < kCreaseCosine || glm::dot(p.geometric_normal, q.geometric_normal) < kCreaseCosine)
      return 0.0f;
    const Vec3 between = q.position - p.position;
    const float apart2 = glm::dot(between, between);
    if (apart2 == 0.0f) return 1.0f;
    const float off_p = glm::dot(between, p.geometric_normal), off_q = glm::dot(between, q.geometric_normal);
    const float step2 = std::max(off_p * off_p, off_q * off_q) / (kPlaneTolerance * kPlaneTolerance * apart2);
    return step2 >= 1.0f ? 0.0f : (1.0f - step2) * power(std::min(cosine, 1.0f), options_.normal_power);
  }

  float likeness(std::size_t i, std::size_t j, std::span<const float> in) const {
    float squares = 0.0f;
    for (std::size_t c = 0; c < channels_; ++c) {
      const float difference = in[i * channels_ + c] - in[j * channels_ + c];
      squares += difference * difference;
    }
    const float allowed = options_.error_scale * options_.error_scale *
                          (error_[i] * error_[i] + error_[j] * error_[j]) * static_cast<float>(channels_);
    return squares < allowed ? 1.0f - squares / allowed : 0.0f;
  }

  const atlas::Texels& texels_;
  const std::span<const float> error_;
  const std::span<const std::uint8_t> valid_;
  const std::size_t channels_;
  const FilterOptions options_;
  const int width_, height_;
  std::vector<std::uint32_t> point_of_;  // by texel
};

}  // namespace

void filterTexels(const atlas::Texels& texels, std::span<const float> error,
                  std::span<const std::uint8_t> valid, int channels, std::span<float> values,
                  std::span<float> error_left, const FilterOptions& options) {
  const std::size_t points = texels.points.size();
  RELUME_CHECK(channels > 0 && options.radius > 0 && options.normal_power >= 0);
  RELUME_CHECK_EQ(values.size(), points * static_cast<std::size_t>(channels));
  RELUME_CHECK_EQ(error.size(), points);
  RELUME_CHECK(valid.empty() || valid.size() == points);
  RELUME_CHECK(error_left.empty() || error_left.size() == points);
  const std::vector<float> in(values.begin(), values.end());
  const Filter filter(texels, error, valid, channels, options);
  parallelFor(points, 1024, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const float left = filter.apply(i, in, &values[i * static_cast<std::size_t>(channels)]);
      if (!error_left.empty()) error_left[i] = left;
    }
  });
}

}  // namespace relume::transport
