// SPDX-License-Identifier: MIT
// Which pixels differ visibly.
// Based on: H. Yee. A Perceptual Metric for Production Testing. Journal of Graphics Tools 9(4), 2004, and its
// program
//   perceptualdiff, after H. Yee, S. Pattanaik, D. Greenberg. Spatiotemporal Sensitivity and Visual Attention
//   for Efficient Rendering of Dynamic Environments. ACM TOG 20(1), 2001.
//
// Per pixel, with luminances L_i of pyramid level i (8 levels), contrast c_i = |L_i - L_i+1| / L_i+2 (the
// larger of the two images), frequency f_i = f_0 / 2^i, f_0 half the pixels per degree, and adaptation
// luminance La (the mean of both images at the level of about one degree):
//   factor = sum c_i F_i M_i / sum c_i, within [1, 10];  i = 0 ... 5
//   F_i = csf(3.248, 100) / csf(f_i, 100),  M_i = mask(c_i csf(f_i, La))
//   visible when |L_0 - L_0'| > factor tvi(La), or, for La >= 10 cd m^-2, when da*^2 + db*^2 > factor.
// csf: P. Barten, SPIE 1077, 1989. mask: S. Daly, 1993. tvi: G. Ward Larson et al., IEEE TVCG 3(4), 1997.
//
// Differs: Rec. 709 primaries (perceptualdiff: Adobe RGB) and linear input (no gamma).
// Limits: as in perceptualdiff, level i is level i - 1 filtered once more by the same 5 x 5 kernel, so levels
// are closer than octaves and local adaptation covers some ten pixels rather than a degree. Kept, so that
// counts can be compared.
#include <algorithm>
#include <array>
#include <cmath>

#include "metrics_common.h"
#include "relume/core/check.h"
#include "relume/core/light.h"
#include "relume/core/parallel.h"
#include "relume/image/metrics.h"

namespace relume::image {
namespace {

constexpr int kLevels = 8, kBands = kLevels - 2, kKernelRadius = 2;
constexpr int kReach = kKernelRadius * (kLevels - 1);
constexpr float kKernel[2 * kKernelRadius + 1] = {0.05f, 0.25f, 0.4f, 0.25f, 0.05f};
constexpr float kTiny = 1e-5f;               // keeps quotients and logarithms finite
constexpr float kScotopicLuminance = 10.0f;  // cd m^-2, colours are not seen below

/// Threshold against intensity, both cd m^-2.
float tvi(float adaptation) {
  const float l = std::log10(adaptation);
  float r = l - 1.255f;
  if (l < -3.94f)
    r = -2.86f;
  else if (l < -1.44f)
    r = std::pow(0.405f * l + 1.6f, 2.18f) - 2.86f;
  else if (l < -0.0184f)
    r = l - 0.395f;
  else if (l < 1.9f)
    r = std::pow(0.249f * l + 0.65f, 2.7f) - 0.72f;
  return std::pow(10.0f, r);
}

/// Contrast sensitivity at one adaptation luminance; its two powers are shared by all frequencies.
struct Sensitivity {
  float a, b;
  explicit Sensitivity(float adaptation)
      : a(440.0f * std::pow(1.0f + 0.7f / adaptation, -0.2f)),
        b(0.3f * std::pow(1.0f + 100.0f / adaptation, 0.15f)) {}
  float at(float cycles_per_degree) const {
    const float e = std::exp(-b * cycles_per_degree);
    return a * cycles_per_degree *
           std::sqrt(e * e + 0.06f * e);  // Barten's exp(-bf) sqrt(1 + 0.06 exp(bf)), no overflow
  }
};

/// Threshold elevation by the contrast around, 1 or more.
float mask(float contrast) {
  const float a = std::pow(392.498f * contrast, 0.7f);
  const float b = std::pow(0.0153f * a, 4.0f);
  return std::pow(1.0f + b, 0.25f);
}

/// CIE a* and b* of linear Rec. 709.
Vec2 chroma(Vec3 rgb) {
  const auto f = [](float t) {
    return t > 216.0f / 24389.0f ? std::cbrt(t) : (24389.0f / 27.0f * t + 16.0f) / 116.0f;
  };
  const float x = glm::dot(rgb, Vec3(0.4124f, 0.3576f, 0.1805f)) / 0.9505f;
  const float y = luminance(rgb);
  const float z = glm::dot(rgb, Vec3(0.0193f, 0.1192f, 0.9505f)) / 1.089f;
  return {500.0f * (f(x) - f(y)), 200.0f * (f(y) - f(z))};
}

// Left and above, the border pixel is the mirror; right and below, the border itself, as in perceptualdiff.
int mirrored(int i, int count) {
  const int j = i < 0 ? -i : i >= count ? 2 * count - i - 1 : i;
  return std::clamp(j, 0, count - 1);
}

// The levels of a strip of rows. Level i covers the rows that level i + 1 and the strip need.
class Pyramid {
  struct Level {
    int first = 0, last = 0;
    std::vector<float> data;
  };
  template <class L>
  auto row(L& level, int y) const {
    return level.data.data() + static_cast<std::size_t>(y - level.first) * static_cast<std::size_t>(width_);
  }

 public:
  Pyramid(const Image& image, int begin, int end, float white) : width_(image.width), height_(image.height) {
    for (int i = 0; i < kLevels; ++i) {
      const int margin = kReach - i * kKernelRadius;
      Level& level = levels_[static_cast<std::size_t>(i)];
      level.first = std::max(0, begin - margin);
      level.last = std::min(height_, end + margin);
      level.data.resize(static_cast<std::size_t>(level.last - level.first) *
                        static_cast<std::size_t>(width_));
      if (i > 0) {
        filter(levels_[static_cast<std::size_t>(i - 1)], level);
        continue;
      }
      for (int y = level.first; y < level.last; ++y)
        for (int x = 0; x < width_; ++x) row(level, y)[x] = white * luminance(image.rgb(x, y));
    }
  }
  float at(int x, int y, int level) const { return row(levels_[static_cast<std::size_t>(level)], y)[x]; }

 private:
  void filter(const Level& from, Level& to) const {
    std::vector<float> padded(static_cast<std::size_t>(width_ + 2 * kKernelRadius));
    for (int y = to.first; y < to.last; ++y) {
      float* middle = padded.data() + kKernelRadius;
      std::fill(padded.begin(), padded.end(), 0.0f);
      for (int k = -kKernelRadius; k <= kKernelRadius; ++k) {
        const float* in = row(from, mirrored(y + k, height_));
        for (int x = 0; x < width_; ++x) middle[x] += kKernel[k + kKernelRadius] * in[x];
      }
      for (int k = 1; k <= kKernelRadius; ++k) {
        middle[-k] = middle[mirrored(-k, width_)];
        middle[width_ - 1 + k] = middle[mirrored(width_ - 1 + k, width_)];
      }
      float* out = row(to, y);
      for (int x = 0; x < width_; ++x) {
        float sum = 0;
        for (int k = -kKernelRadius; k <= kKernelRadius; ++k)
          sum += kKernel[k + kKernelRadius] * middle[x + k];
        out[x] = sum;
      }
    }
  }

  int width_, height_;
  std::array<Level, kLevels> levels_;
};

struct Viewing {
  int adaptation_level = 0;
  std::array<float, kBands> frequency{}, elevation{};  // f_i in cycles per degree, F_i

  Viewing(int width, double field_of_view_deg) {
    constexpr double kRadians = 3.14159265358979323846 / 180.0;
    const double degrees = 2.0 * std::tan(0.5 * field_of_view_deg * kRadians) / kRadians;
    while (adaptation_level < kLevels - 1 && std::exp2(adaptation_level) <= degrees) ++adaptation_level;
    const Sensitivity at_white(100.0f);
    for (std::size_t i = 0; i < kBands; ++i) {
      frequency[i] = static_cast<float>(0.5 * width / degrees / std::exp2(i));
      elevation[i] = at_white.at(3.248f) / std::max(at_white.at(frequency[i]), 1e-30f);
    }
  }
};

float thresholdFactor(const Pyramid& a, const Pyramid& b, int x, int y, const Viewing& viewing,
                      float adaptation) {
  const Sensitivity sensitivity(adaptation);
  float contrast_sum = 0, factor = 0;
  for (int i = 0; i < kBands; ++i) {
    const auto band = static_cast<std::size_t>(i);
    const float change =
        std::max(std::abs(a.at(x, y, i) - a.at(x, y, i + 1)), std::abs(b.at(x, y, i) - b.at(x, y, i + 1)));
    const float level = std::max({std::abs(a.at(x, y, i + 2)), std::abs(b.at(x, y, i + 2)), kTiny});
    const float contrast = change / level;
    factor += contrast * viewing.elevation[band] * mask(contrast * sensitivity.at(viewing.frequency[band]));
    contrast_sum += contrast;
  }
  return std::clamp(factor / std::max(contrast_sum, kTiny), 1.0f, 10.0f);
}

}  // namespace

Yee yee(const Image& test, const Image& reference, const YeeOptions& options) {
  RELUME_CHECK(options.field_of_view_deg > 0.0 && options.field_of_view_deg < 180.0);
  RELUME_CHECK_LT(0.0, options.luminance_white);
  detail::requireComparable(test, reference);
  detail::requireFinite(test, "first image");
  detail::requireFinite(reference, "second image");

  const Viewing viewing(test.width, options.field_of_view_deg);
  const auto white = static_cast<float>(options.luminance_white);
  Yee out;
  out.map = Image(test.width, test.height, 1);
  parallelFor(
      static_cast<std::size_t>(test.height), detail::kStripRows, [&](std::size_t begin, std::size_t end) {
        const auto first = static_cast<int>(begin), last = static_cast<int>(end);
        const Pyramid a(test, first, last, white), b(reference, first, last, white);
        for (int y = first; y < last; ++y) {
          for (int x = 0; x < test.width; ++x) {
            const float adaptation = std::max(
                0.5f * (a.at(x, y, viewing.adaptation_level) + b.at(x, y, viewing.adaptation_level)), kTiny);
            const float luminance_excess = std::abs(a.at(x, y, 0) - b.at(x, y, 0)) / tvi(adaptation);
            float colour_excess = 0;
            if (adaptation >= kScotopicLuminance) {
              const Vec2 d = chroma(test.rgb(x, y)) - chroma(reference.rgb(x, y));
              colour_excess = static_cast<float>(options.colour_factor) * glm::dot(d, d);
            }
            const float excess = std::max(luminance_excess, colour_excess);
            // The factor is at least 1, so most pixels need no masking.
            if (excess > 1.0f && excess > thresholdFactor(a, b, x, y, viewing, adaptation))
              *out.map.at(x, y) = 1.0f;
          }
        }
      });
  out.visible_pixels = static_cast<std::size_t>(std::count(out.map.data.begin(), out.map.data.end(), 1.0f));
  return out;
}

}  // namespace relume::image
