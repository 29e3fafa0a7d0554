// SPDX-License-Identifier: MIT
// Light that comes from infinitely far away, from every direction: one radiance, or an equirectangular image.
#pragma once
#include <memory>

#include "relume/core/quantity.h"
#include "relume/core/vec.h"
#include "relume/image/image.h"

namespace relume::scene {

/// Where a direction falls in an equirectangular image: u = 1/2 + atan2(z, x) / (2 pi), v = acos(y) / pi, the
/// top row being +y. +x is in the middle and -z at a quarter of the width, as three.js has it.
Vec2 equirectFromDirection(Direction d);
Direction directionFromEquirect(Vec2 uv);

struct Environment {
  Radiance radiance{0.0f};                  ///< of every direction; with a map, what the map is multiplied by
  std::shared_ptr<const image::Image> map;  ///< equirectangular, at least 3 channels; null: constant
  float rotation = 0.0f;  ///< radians by which the map is turned counter-clockwise about +y, seen from above

  bool dark() const { return radiance == Radiance(0.0f); }
  /// Radiance that arrives from direction d (unit, pointing away from the receiver); bilinear in the map.
  Radiance from(Direction d) const;
  /// d as the map knows it, and back.
  Direction mapFromWorld(Direction d) const;
  Direction worldFromMap(Direction d) const;
};

}  // namespace relume::scene
