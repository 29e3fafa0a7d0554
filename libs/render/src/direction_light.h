// SPDX-License-Identifier: MIT
// A layer `directional` on the device: its maps, and what shaders/directions.glsl asks of its set.
#pragma once
#include "gl_objects.h"
#include "relume/asset/direction_maps.h"

namespace relume::render {

class DirectionLight {
 public:
  DirectionLight(const asset::DirectionMaps& maps, const asset::AtlasTable& atlas);
  int directions() const { return count_; }
  void bind() const;

 private:
  int count_;
  Texture charts_, maps_;
  Buffer set_, points_, chart_boxes_, rectangles_;
};

}  // namespace relume::render
