// SPDX-License-Identifier: MIT
// Lights of every kind about the room of made_bake.h.
#pragma once
#include <random>

#include "relume/core/light.h"

namespace relume::relight {

inline LightSet someLights(std::size_t count) {
  std::mt19937 random(2);
  std::uniform_real_distribution<float> unit;
  LightSet lights(count);
  for (std::size_t i = 0; i < count; ++i) {
    Light& l = lights[i];
    l.kind = static_cast<Light::Kind>(i % 4);
    l.colour = {unit(random), unit(random), unit(random)};
    l.intensity = 10 * unit(random);
    l.position = Vec3(4, 3, 5) * Vec3(unit(random), unit(random), unit(random));
    l.direction = glm::normalize(Vec3(unit(random) - 0.5f, -1, unit(random) - 0.5f));
    l.range = i % 3 == 0 ? 4 : kInfinity;
    l.inner_cone = 0.2f, l.outer_cone = 0.9f;
    l.area = 0.1f + unit(random);
    l.two_sided = i % 8 == 3;
  }
  return lights;
}

}  // namespace relume::relight
