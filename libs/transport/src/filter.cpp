// SPDX-License-Identifier: MIT
// Edge-aware smoothing of texel values: a joint bilateral filter. A neighbour's weight is the product of
//   a Gaussian of its distance in texels,
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

class Filter {
 public:
  Filter(const atlas::Texels& texels, std::span<const float> error, std::span<const std::uint8_t> valid,
         int channels, const FilterOptions& options)
      : texels_(texels),
        error_(error),
        valid_(valid),
        channels_(static_cast<std::size_t>(channels)),
        options_(options),
        point_of_(static_cast<std::size_t>(texels.pages) * static_cast<std::size_t>(texels.height) *
                      static_cast<std::size_t>(texels.width),
                  scene::kNone) {
    for (std::size_t i = 0; i < texels.points.size(); ++i) {
      if (usable(i)) point_of_[texels.points[i].texel] = static_cast<std::uint32_t>(i);
    }
  }

  /// The filtered values of point i; in: [points][channels], out: [channels].
  void apply(std::size_t i, std::span<const float> in, float* out) const {
    const float* centre = &in[i * channels_];
    std::copy_n(centre, channels_, out);
    if (!usable(i)) return;
    const int radius = options_.radius;
    const float falloff = -2.0f / static_cast<float>(radius * radius);
    float total = 1.0f;
    for (int dy = 0; dy <= radius; ++dy) {
      for (int dx = dy == 0 ? 1 : -radius; dx <= radius; ++dx) {
        const std::uint32_t a = neighbour(i, dx, dy), b = neighbour(i, -dx, -dy);
        if (a == scene::kNone || b == scene::kNone) continue;
        const float weight = std::min(geometry(i, a), geometry(i, b)) *
                             std::min(likeness(i, a, in), likeness(i, b, in)) *
                             std::exp(falloff * static_cast<float>(dx * dx + dy * dy));
        if (weight <= 0.0f) continue;
        for (std::size_t c = 0; c < channels_; ++c)
          out[c] += weight * (in[a * channels_ + c] + in[b * channels_ + c]);
        total += 2.0f * weight;
      }
    }
    for (std::size_t c = 0; c < channels_; ++c) out[c] /= total;
  }

 private:
  bool usable(std::size_t i) const { return valid_.empty() || valid_[i] != 0; }

  std::uint32_t neighbour(std::size_t i, int dx, int dy) const {
    const auto width = static_cast<std::int64_t>(texels_.width),
               height = static_cast<std::int64_t>(texels_.height);
    const std::int64_t texel = texels_.points[i].texel;
    const std::int64_t x = texel % width + dx, row = texel / width + dy, page = texel / (width * height);
    if (x < 0 || x >= width || row < page * height || row >= (page + 1) * height) return scene::kNone;
    const std::uint32_t found = point_of_[static_cast<std::size_t>(row * width + x)];
    return found != scene::kNone && texels_.points[found].chart == texels_.points[i].chart ? found
                                                                                           : scene::kNone;
  }

  float geometry(std::size_t i, std::size_t j) const {
    const atlas::SurfacePoint &p = texels_.points[i], &q = texels_.points[j];
    const float cosine = glm::dot(p.shading_normal, q.shading_normal);
    if (cosine < kCreaseCosine || glm::dot(p.geometric_normal, q.geometric_normal) < kCreaseCosine)
      return 0.0f;
    const Vec3 between = q.position - p.position;
    const float apart = glm::length(between);
    if (apart == 0.0f) return 1.0f;
    const float off = std::max(std::abs(glm::dot(between, p.geometric_normal)),
                               std::abs(glm::dot(between, q.geometric_normal)));
    const float step = off / (kPlaneTolerance * apart);
    return step >= 1.0f ? 0.0f : (1.0f - step * step) * std::pow(cosine, options_.normal_power);
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
  std::vector<std::uint32_t> point_of_;  // by texel
};

}  // namespace

void filterTexels(const atlas::Texels& texels, std::span<const float> error,
                  std::span<const std::uint8_t> valid, int channels, std::span<float> values,
                  const FilterOptions& options) {
  const std::size_t points = texels.points.size();
  RELUME_CHECK(channels > 0 && options.radius > 0);
  RELUME_CHECK_EQ(values.size(), points * static_cast<std::size_t>(channels));
  RELUME_CHECK_EQ(error.size(), points);
  RELUME_CHECK(valid.empty() || valid.size() == points);
  const std::vector<float> in(values.begin(), values.end());
  const Filter filter(texels, error, valid, channels, options);
  parallelFor(points, 1024, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      filter.apply(i, in, &values[i * static_cast<std::size_t>(channels)]);
  });
}

}  // namespace relume::transport
