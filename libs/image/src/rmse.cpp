// SPDX-License-Identifier: MIT
// With N selected values (pixels times colour channels):
//   rmse = sqrt(sum (t - r)^2 / N),  relative = rmse / sqrt(sum r^2 / N),  bias = sum (t - r) / sum r
// A quotient with a zero denominator is 0 when its numerator is 0, else infinite.
#include <cmath>
#include <limits>

#include "metrics_common.h"
#include "relume/core/error.h"
#include "relume/image/metrics.h"

namespace relume::image {
namespace {

double quotient(double a, double b) {
  if (b != 0.0) return a / b;
  return a == 0.0 ? 0.0 : std::copysign(std::numeric_limits<double>::infinity(), a);
}

}  // namespace

Rmse rmse(const Image& test, const Image& reference, const Image* mask) {
  detail::requireComparable(test, reference);
  if (mask && (mask->width != test.width || mask->height != test.height || mask->channels != 1))
    throw Error(ErrorCode::kMismatch, "mask", "does not have the images' size and one channel");
  detail::requireFinite(test, "first image", mask);
  detail::requireFinite(reference, "second image", mask);

  const auto colours = static_cast<std::size_t>(detail::colourChannels(test));
  Rmse out;
  out.map = Image(test.width, test.height, 1);
  std::vector<float> errors;
  if (!mask) errors.reserve(test.pixels());
  double sum = 0, sum2 = 0, reference_sum = 0, reference_sum2 = 0;
  for (std::size_t p = 0; p < test.pixels(); ++p) {
    if (mask && !(mask->data[p] > 0.5f)) continue;
    const float* t = test.data.data() + p * static_cast<std::size_t>(test.channels);
    const float* r = reference.data.data() + p * static_cast<std::size_t>(reference.channels);
    double absolute = 0;
    for (std::size_t c = 0; c < colours; ++c) {
      const double d = double{t[c]} - double{r[c]};
      sum += d;
      sum2 += d * d;
      absolute += std::abs(d);
      reference_sum += r[c];
      reference_sum2 += double{r[c]} * double{r[c]};
    }
    out.map.data[p] = static_cast<float>(absolute / static_cast<double>(colours));
    errors.push_back(out.map.data[p]);
  }
  if (errors.empty()) throw Error(ErrorCode::kInvalidValue, "mask", "selects no pixel");
  const double count = static_cast<double>(errors.size() * colours);
  out.rmse = std::sqrt(sum2 / count);
  out.relative = quotient(out.rmse, std::sqrt(reference_sum2 / count));
  out.bias = quotient(sum, reference_sum);
  out.p99 = detail::quantile(errors, 0.99);
  out.max = detail::quantile(errors, 1.0);
  return out;
}

}  // namespace relume::image
