// SPDX-License-Identifier: MIT
#pragma once

namespace relume::transport {

/// The weight of a sample of one strategy where another could have found it too ([Veach97] (9.13), exponent
/// 2). By the ratio, which squares of large densities would not survive.
inline float powerHeuristic(float own, float other) {
  const float ratio = other / own;
  return 1 / (1 + ratio * ratio);
}

}  // namespace relume::transport
