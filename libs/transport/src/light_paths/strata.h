// SPDX-License-Identifier: MIT
// Stratified random choice among weighted items.
#pragma once
#include <cstdint>
#include <span>

#include "relume/core/sampling.h"

namespace relume::transport {

/// Cuts `items` into `count` stretches of equal weight and calls visit(stretch, item, u) for an item of each,
/// chosen by weight, with u in [0, 1)^2 for what else there is to choose. weight: by item, not negative.
/// There is an item.
template <class Visit>
void forEachStratum(std::span<const std::uint32_t> items, std::span<const float> weight, std::uint32_t count,
                    std::uint32_t stream, const Visit& visit) {
  double all = 0, so_far = 0;
  for (const std::uint32_t item : items) all += static_cast<double>(weight[item]);
  std::size_t at = 0;
  for (std::uint32_t k = 0; k < count; ++k) {
    const Vec2 u = sobol2(k, stream), v = sobol2(k, hashCombine(stream, 1));
    const double target = (k + static_cast<double>(v.x)) / count * all;
    while (at + 1 < items.size() && so_far + static_cast<double>(weight[items[at]]) <= target)
      so_far += static_cast<double>(weight[items[at++]]);
    visit(k, items[at], u);
  }
}

}  // namespace relume::transport
