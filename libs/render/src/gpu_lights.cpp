// SPDX-License-Identifier: MIT
#include "gpu_lights.h"

#include <algorithm>
#include <cmath>

namespace relume::render {

GpuLight toGpu(const Light& light, int shadow_layer, Point shadow_origin) {
  const float cos_outer = std::cos(light.outer_cone);
  GpuLight out;
  out.position_kind = Vec4(light.position, static_cast<float>(light.kind));
  out.direction_back = Vec4(light.direction, light.two_sided ? 1.0f : 0.0f);
  out.strength_area = Vec4(light.colour * light.intensity, light.area);
  out.cone =
      Vec4(light.range < kInfinity ? 1 / (light.range * light.range) : 0.0f, cos_outer,
           1 / std::max(0.001f, std::cos(light.inner_cone) - cos_outer), static_cast<float>(shadow_layer));
  out.shadow_origin = Vec4(shadow_origin, 0);
  return out;
}

bool sameButStrength(const Light& a, const Light& b) {
  return a.kind == b.kind && a.range == b.range && a.inner_cone == b.inner_cone &&
         a.outer_cone == b.outer_cone && a.position == b.position && a.direction == b.direction &&
         a.area == b.area && a.two_sided == b.two_sided;
}

}  // namespace relume::render
