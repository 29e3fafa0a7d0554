// SPDX-License-Identifier: MIT
// Orthonormal frames about a normal.
// Based on:
//   [Duff17] Duff et al. Building an Orthonormal Basis, Revisited. JCGT 6(1), 2017.
#pragma once
#include <cmath>

#include "relume/core/vec.h"

namespace relume {

/// Right-handed orthonormal frame: t x b = n.
struct Frame {
  Direction t, b, n;

  /// Any frame about n, continuous but for the south pole ([Duff17] Listing 3).
  static Frame about(Normal n) {
    const float sign = std::copysign(1.0f, n.z);
    const float a = -1.0f / (sign + n.z);
    const float c = n.x * n.y * a;
    return {{1.0f + sign * n.x * n.x * a, sign * c, -sign * n.x}, {c, sign + n.y * n.y * a, -n.y}, n};
  }
  Vec3 toWorld(Vec3 local) const { return local.x * t + local.y * b + local.z * n; }
  Vec3 toLocal(Vec3 world) const { return {glm::dot(world, t), glm::dot(world, b), glm::dot(world, n)}; }
};

}  // namespace relume
