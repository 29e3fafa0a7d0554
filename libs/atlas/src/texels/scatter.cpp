// SPDX-License-Identifier: MIT
#include <algorithm>

#include "relume/atlas/texels.h"
#include "relume/core/check.h"
#include "relume/core/parallel.h"

namespace relume::atlas {

void scatter(const Texels& texels, std::span<const float> values, int channels,
             std::span<const std::uint8_t> valid, std::vector<float>& pages,
             std::vector<std::uint8_t>& covered) {
  const std::size_t stride = static_cast<std::size_t>(channels), points = texels.points.size();
  RELUME_CHECK_EQ(values.size(), points * stride);
  RELUME_CHECK(valid.empty() || valid.size() == points);
  const std::size_t total = std::size_t{texels.pages} * static_cast<std::size_t>(texels.width) *
                            static_cast<std::size_t>(texels.height);
  pages.assign(total * stride, 0.0f);
  covered.assign(total, 0);
  parallelFor(points, 1 << 16, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      if (!valid.empty() && valid[i] == 0) continue;
      const std::size_t texel = texels.points[i].texel;
      covered[texel] = 1;
      std::copy_n(values.begin() + static_cast<std::ptrdiff_t>(i * stride), stride,
                  pages.begin() + static_cast<std::ptrdiff_t>(texel * stride));
    }
  });
}

}  // namespace relume::atlas
