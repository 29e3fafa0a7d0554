// SPDX-License-Identifier: MIT
// Light sources that glTF can name (KHR_lights_punctual) and area lights, shared by the baker and the
// run-time.
#pragma once
#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "relume/core/quantity.h"
#include "relume/core/vec.h"

namespace relume {

struct Light {
  enum class Kind : std::uint8_t { kPoint, kSpot, kDirectional, kArea };
  Kind kind = Kind::kPoint;
  std::string name;
  std::string
      group;  ///< of lights that are dimmed and coloured together; empty: the light alone, by its name
  Vec3 colour{1.0f};
  float intensity = 1.0f;   ///< cd (point, spot), lux (directional), radiance W m^-2 sr^-1 (area)
  float range = kInfinity;  ///< metres; punctual lights fade to zero there
  float inner_cone = 0.0f, outer_cone = kPi / 4;  ///< radians from the axis, spot
  Point position{0.0f};                           ///< world; area: the middle
  Direction direction{0, 0, -1};  ///< world, the way the light travels; area: the side it shines to
  float area = 0.0f;              ///< m^2, area lights
  bool two_sided = false;         ///< area: shines to the other side too
  /// Area: those that make up a flat polygon, world, counter-clockwise seen from where it shines to; none: a
  /// disk.
  std::vector<std::array<Point, 3>> triangles;
  float angular_radius = 0.0f;  ///< radians, directional: half of what its disk subtends; 0: a point
};
using LightSet = std::vector<Light>;

/// Irradiance at p on a plane that faces the light, no occlusion: I / r^2 with KHR_lights_punctual's range
/// window and cone; directional: its lux; area: L A cos_l / (r^2 + A / pi), exact on the axis of a disk
/// (multi-scale PRT, section 10), which a polygon is taken for.
Irradiance incidentIrradiance(const Light& light, Point p);
/// Unit direction from p to the light, and how far it is (infinite for directional).
Direction directionTo(const Light& light, Point p);
float distanceTo(const Light& light, Point p);
/// incidentIrradiance times the clamped cosine at a receiver with normal n.
Irradiance directIrradiance(const Light& light, Point p, Normal n);
/// A place on an area light, equal shares of its area for equal shares of the square, u in [0, 1)^2; of other
/// lights their position.
Point pointOn(const Light& light, Vec2 u);

}  // namespace relume
