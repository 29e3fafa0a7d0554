// SPDX-License-Identifier: MIT
// Where a ray that leaves a surface starts: integer steps of the coordinates' own spacing far from the
// world's origin, a fixed length near it, where the spacing vanishes but errors of the surface's other
// coordinates do not. Based on:
//   [WB19] Waechter, Binder. A Fast and Robust Method for Avoiding Self-Intersection. Ray Tracing Gems ch. 6,
//   2019.
#include <bit>
#include <cmath>
#include <cstdint>

#include "relume/trace/tracer.h"

namespace relume::trace {

Point offsetOrigin(Point p, Normal geometric_normal) {
  constexpr float kNearOrigin = 1.0f / 32.0f;  // metres
  constexpr float kLength = 1.0f / 65536.0f;   // metres per unit of normal, near the origin
  constexpr float kSteps = 256.0f;             // float spacings per unit of normal
  const auto moved = [](float x, float n) {
    if (std::abs(x) < kNearOrigin) return x + kLength * n;
    // The magnitude's bits count its spacings, so a step away from zero adds and one towards it subtracts.
    const auto steps = static_cast<std::int32_t>(kSteps * n);
    return std::bit_cast<float>(std::bit_cast<std::int32_t>(x) + (x < 0.0f ? -steps : steps));
  };
  return {moved(p.x, geometric_normal.x), moved(p.y, geometric_normal.y), moved(p.z, geometric_normal.z)};
}

}  // namespace relume::trace
