// SPDX-License-Identifier: MIT
// Where a ray that leaves a surface starts: integer steps of the coordinates' own spacing far from the
// world's origin, a fixed length near it, where the spacing vanishes but errors of the surface's other
// coordinates do not; and no less than a few spacings of the largest coordinate, because transforms mix them:
// of a Cornell box 550 units wide, placed by a node, a wall at x = 0 was black in places. Based on:
//   [WB19] Waechter, Binder. A Fast and Robust Method for Avoiding Self-Intersection. Ray Tracing Gems ch. 6,
//   2019.
#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>

#include "relume/trace/tracer.h"

namespace relume::trace {

Point offsetOrigin(Point p, Normal geometric_normal) {
  constexpr float kNearOrigin = 1.0f / 32.0f;  // metres
  constexpr float kLength = 1.0f / 65536.0f;   // metres per unit of normal, near the origin
  constexpr float kSteps = 256.0f;             // float spacings per unit of normal
  constexpr float kShare = 0x1p-21f;           // of the largest coordinate: four of its spacings or more
  const float largest = std::max({std::abs(p.x), std::abs(p.y), std::abs(p.z)});
  const float near = std::max(kNearOrigin, largest / 32.0f), length = std::max(kLength, largest * kShare);
  const auto moved = [near, length](float x, float n) {
    if (std::abs(x) < near) return x + length * n;
    // The magnitude's bits count its spacings, so a step away from zero adds and one towards it subtracts.
    const auto steps = static_cast<std::int32_t>(kSteps * n);
    return std::bit_cast<float>(std::bit_cast<std::int32_t>(x) + (x < 0.0f ? -steps : steps));
  };
  return {moved(p.x, geometric_normal.x), moved(p.y, geometric_normal.y), moved(p.z, geometric_normal.z)};
}

}  // namespace relume::trace
