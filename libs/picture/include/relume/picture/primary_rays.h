// SPDX-License-Identifier: MIT
// From places in the picture to rays in the world.
#pragma once
#include "relume/picture/picture.h"

namespace relume::picture {

/// A pinhole or orthographic camera over a picture of width x height pixels.
class PrimaryRays {
 public:
  PrimaryRays(const Viewpoint& viewpoint, int width, int height);
  /// `place` in pixels; (0, 0) is the upper left corner of the picture, pixel centres lie at + 0.5.
  trace::Ray at(Vec2 place) const;

 private:
  Point eye_;
  Direction right_, up_, forward_;
  Vec2 half_extent_;  ///< of the picture at distance 1 (perspective) or in metres (orthographic)
  Vec2 size_;
  bool orthographic_;
};

}  // namespace relume::picture
