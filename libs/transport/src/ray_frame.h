// SPDX-License-Identifier: MIT
// Which directions count at a surface point.
#pragma once
#include "relume/core/frame.h"

namespace relume::transport {

/// Directions are cosine-weighted about the *shading* normal, because that is the normal the baked value is
/// used with. Those below the true surface, where the interpolated normal leans over it, are discarded, and
/// the rest is divided by their own number. So a convex body of few, smoothly shaded faces is unoccluded, as
/// the curved body that it stands for; an estimator that called such directions blocked (or that sends them
/// into the body, as Cycles does) darkens it by up to (1 - cos of the lean) / 2 at the faces' rims. A shading
/// normal on the far side of the surface is none: then the geometric normal serves.
struct RayFrame {
  Frame shading;
  Normal geometric;

  RayFrame(Normal shading_normal, Normal geometric_normal)
      : shading(Frame::about(glm::dot(shading_normal, geometric_normal) > 0.0f ? shading_normal
                                                                               : geometric_normal)),
        geometric(geometric_normal) {}

  /// Below this cosine a ray would run in the surface's own plane, where rounding decides what it hits.
  static constexpr float kGrazing = 5e-5f;
  static bool above(Direction direction, Normal geometric_normal) {
    return glm::dot(direction, geometric_normal) > kGrazing;
  }
};

}  // namespace relume::transport
