// SPDX-License-Identifier: MIT
// Who receives light: a surface, its normal, and a frame about it that needs no tangents of a mesh.
#pragma once
#include "relume/core/frame.h"
#include "relume/core/quantity.h"

namespace relume::basis {

/// The frame that the shortest rotation makes of a fixed frame about a fixed axis. It turns by as much as
/// normals do, without a jump but for one direction, the opposite of the axis, which lies away from walls,
/// floors and slopes of 45 degrees: numbers in it can be mixed between texels and between charts, and a
/// shader makes it from the normal alone.
Frame tangentFrame(Normal n);

struct Receiver {
  explicit Receiver(Normal n) : normal(n), frame(tangentFrame(n)) {}
  Normal normal;  ///< world, unit: of the surface, before any normal map
  Frame frame;    ///< about it
};

/// Light that arrives at a surface.
struct Arrival {
  Direction from{0, 0, 1};  ///< unit, towards where it comes from
  Irradiance e;             ///< on the surface
  float cosine = 1.0f;  ///< of the angle at which it arrives, above 0: e / cosine = radiance * solid angle
};

}  // namespace relume::basis
