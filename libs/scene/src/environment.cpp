// SPDX-License-Identifier: MIT
#include "relume/scene/environment.h"

#include <algorithm>
#include <cmath>

namespace relume::scene {
namespace {

Direction turned(Direction d, float angle) {
  if (angle == 0) return d;
  const float c = std::cos(angle), s = std::sin(angle);
  return {c * d.x + s * d.z, d.y, -s * d.x + c * d.z};
}

}  // namespace

Vec2 equirectFromDirection(Direction d) {
  const float u = 0.5f + std::atan2(d.z, d.x) * (0.5f * kInvPi);
  return {u < 1.0f ? u : 0.0f, std::acos(std::clamp(d.y, -1.0f, 1.0f)) * kInvPi};
}

Direction directionFromEquirect(Vec2 uv) {
  const float phi = (uv.x - 0.5f) * 2.0f * kPi, theta = uv.y * kPi;
  return {std::sin(theta) * std::cos(phi), std::cos(theta), std::sin(theta) * std::sin(phi)};
}

Direction Environment::mapFromWorld(Direction d) const { return turned(d, -rotation); }
Direction Environment::worldFromMap(Direction d) const { return turned(d, rotation); }

Radiance Environment::from(Direction d) const {
  if (!map) return radiance;
  const Vec2 uv = equirectFromDirection(mapFromWorld(d));
  const float x = uv.x * static_cast<float>(map->width) - 0.5f,
              y = uv.y * static_cast<float>(map->height) - 0.5f;
  const float fx = std::floor(x), fy = std::floor(y);
  const auto column = [&](int i) { return i < 0 ? i + map->width : i >= map->width ? i - map->width : i; };
  const auto row = [&](int j) { return std::clamp(j, 0, map->height - 1); };
  const int x0 = column(static_cast<int>(fx)), x1 = column(static_cast<int>(fx) + 1);
  const int y0 = row(static_cast<int>(fy)), y1 = row(static_cast<int>(fy) + 1);
  return Radiance(radiance.rgb * glm::mix(glm::mix(map->rgb(x0, y0), map->rgb(x1, y0), x - fx),
                                          glm::mix(map->rgb(x0, y1), map->rgb(x1, y1), x - fx), y - fy));
}

}  // namespace relume::scene
