// SPDX-License-Identifier: MIT
// The four texels about a place in a page, and their weights.
#pragma once
#include <algorithm>
#include <array>
#include <cstddef>

#include "relume/core/vec.h"

namespace relume::picture {

/// Clamps to [0, hi]; NaN becomes 0, so whatever a file says stays inside its page.
inline float clampIndex(float x, int hi) { return x > 0 ? std::min(x, static_cast<float>(hi)) : 0.0f; }

struct Bilinear {
  std::array<std::size_t, 4> texel;  ///< row * width + column
  std::array<float, 4> weight;
};
/// `place` in texels, (0, 0) being the corner of texel (0, 0).
inline Bilinear bilinearAt(Vec2 place, int width, int height) {
  const float x = clampIndex(place.x - 0.5f, width - 1), y = clampIndex(place.y - 0.5f, height - 1);
  const int x0 = static_cast<int>(x), y0 = static_cast<int>(y);
  const int x1 = std::min(x0 + 1, width - 1), y1 = std::min(y0 + 1, height - 1);
  const float fx = x - static_cast<float>(x0), fy = y - static_cast<float>(y0);
  const auto at = [&](int tx, int ty) {
    return static_cast<std::size_t>(ty) * static_cast<std::size_t>(width) + static_cast<std::size_t>(tx);
  };
  return {{at(x0, y0), at(x1, y0), at(x0, y1), at(x1, y1)},
          {(1 - fx) * (1 - fy), fx * (1 - fy), (1 - fx) * fy, fx * fy}};
}

}  // namespace relume::picture
