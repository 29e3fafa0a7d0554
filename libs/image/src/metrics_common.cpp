// SPDX-License-Identifier: MIT
#include "metrics_common.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "relume/core/check.h"
#include "relume/core/error.h"

namespace relume::image::detail {

void requireComparable(const Image& test, const Image& reference) {
  const auto shape = [](const Image& i) {
    return fmt::format("{} x {} {}", i.width, i.height, colourChannels(i) == 3 ? "colour" : "grey");
  };
  if (shape(test) != shape(reference))
    throw Error(ErrorCode::kMismatch, "images", fmt::format("{} against {}", shape(test), shape(reference)),
                "compare images of one size and kind");
  if (test.pixels() == 0) throw Error(ErrorCode::kMismatch, "images", "have no pixels");
}

void requireFinite(const Image& image, const char* subject, const Image* mask) {
  const auto channels = static_cast<std::size_t>(image.channels);
  const auto colours = static_cast<std::size_t>(colourChannels(image));
  for (std::size_t p = 0; p < image.pixels(); ++p) {
    if (mask && !(mask->data[p] > 0.5f)) continue;
    for (std::size_t c = 0; c < colours; ++c) {
      if (std::isfinite(image.data[p * channels + c])) continue;
      const auto width = static_cast<std::size_t>(image.width);
      throw Error(ErrorCode::kInvalidValue, subject,
                  fmt::format("pixel ({}, {}) is {}", p % width, p / width, image.data[p * channels + c]),
                  "a metric needs finite values; mask the pixel or render the image again");
    }
  }
}

double quantile(std::vector<float>& values, double q) {
  RELUME_CHECK(!values.empty());
  const double rank = std::ceil(q * static_cast<double>(values.size()));
  const auto index = std::min(values.size() - 1, static_cast<std::size_t>(std::max(rank, 1.0)) - 1);
  const auto nth = values.begin() + static_cast<std::ptrdiff_t>(index);
  std::nth_element(values.begin(), nth, values.end());
  return *nth;
}

}  // namespace relume::image::detail
