// SPDX-License-Identifier: MIT
// What the metrics share.
#pragma once
#include <vector>

#include "relume/image/image.h"

namespace relume::image::detail {

/// Throws Error kMismatch unless both have the same size, at least one pixel, and both colour or both grey;
/// an alpha channel counts for nothing.
void requireComparable(const Image& test, const Image& reference);
/// Throws Error kInvalidValue, naming the first pixel of `image` that is not finite; `mask` as in rmse().
void requireFinite(const Image& image, const char* subject, const Image* mask = nullptr);

/// 1 or 3: the channels without alpha.
inline int colourChannels(const Image& image) { return image.channels >= 3 ? 3 : 1; }

/// The smallest value that at least the fraction `q` of `values` does not exceed; reorders them.
double quantile(std::vector<float>& values, double q);

/// Rows that one work item of a metric handles: enough to outweigh the rows its filters need above and below.
inline constexpr int kStripRows = 64;

}  // namespace relume::image::detail
