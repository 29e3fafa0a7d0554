// SPDX-License-Identifier: MIT
#include "texel_rows.h"

#include <algorithm>

namespace relume::transport {
namespace {

/// The first of the points [begin, end) whose texel is not below this one.
std::uint32_t lowerBound(const atlas::Texels& texels, std::uint32_t begin, std::uint32_t end,
                         std::size_t texel) {
  const auto first = texels.points.begin();
  const auto found = std::partition_point(first + begin, first + end,
                                          [&](const atlas::SurfacePoint& p) { return p.texel < texel; });
  return static_cast<std::uint32_t>(found - first);
}

}  // namespace

TexelRows::TexelRows(const atlas::Texels& texels) : texels_(texels) {
  const auto width = static_cast<std::size_t>(texels.width);
  const std::size_t rows = texels.pages * static_cast<std::size_t>(texels.height);
  const auto points = static_cast<std::uint32_t>(texels.points.size());
  begin_.assign(rows + 1, points);
  begin_[0] = 0;
  for (std::size_t row = 1; row < rows; ++row) {
    // A row has at most so many points, which bounds the search.
    const auto most = static_cast<std::uint32_t>(std::min<std::size_t>(points, begin_[row - 1] + width));
    begin_[row] = lowerBound(texels, begin_[row - 1], most, row * width);
  }
}

TexelRows::Range TexelRows::within(std::size_t row, std::uint32_t x_begin, std::uint32_t x_end) const {
  const auto width = static_cast<std::uint32_t>(texels_.width);
  const std::size_t first = row * width;
  Range range{begin_[row], begin_[row + 1]};
  if (x_begin > 0) range.begin = lowerBound(texels_, range.begin, range.end, first + x_begin);
  if (x_end < width) range.end = lowerBound(texels_, range.begin, range.end, first + x_end);
  return range;
}

}  // namespace relume::transport
