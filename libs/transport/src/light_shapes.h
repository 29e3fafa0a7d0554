// SPDX-License-Identifier: MIT
// What emits without being a surface of the scene: area lights of a light file, which are seen but hide
// nothing, and suns. Of each: a sample of its light at a point, and what a ray sees of it with the density of
// that sample. Densities are per steradian and leave out how the emitter was chosen.
#pragma once
#include <optional>

#include "relume/core/frame.h"
#include "relume/transport/emitters.h"

namespace relume::transport {

/// A piece of a ray: where it starts, and the distances between which it is open.
struct OpenRay {
  Point from;
  Direction d;
  float near = 0, far = 0;
};

/// Sampled uniformly in area.
struct Disk {
  Point centre;
  Normal normal;
  float radius;
  Radiance radiance;
  bool two_sided;

  LightSample sample(Point p, Vec2 u) const;
  std::optional<LightSeen> seen(const OpenRay& ray) const;
};

/// A triangle of a polygon; sampled uniformly in solid angle.
struct Panel {
  Point v0, v1, v2;
  Normal normal;
  Radiance radiance;
  bool two_sided;

  LightSample sample(Point p, Vec2 u) const;
  std::optional<LightSeen> seen(const OpenRay& ray) const;
};

/// A directional light. Sampled uniformly in solid angle.
struct Sun {
  Direction to_light;
  float angular_radius;  ///< radians; 0: a delta light
  Vec3 irradiance;       ///< facing it

  bool delta() const { return angular_radius <= 0.0f; }
  /// 1 - cos of the radius, without its cancellation.
  float height() const;
  /// Of a disk of uniform radiance that gives this irradiance to a plane facing its centre: L = E / (pi sin^2
  /// a).
  Radiance radiance() const;
  float pdf() const { return 0.5f * kInvPi / height(); }
  bool covers(Direction d) const;
  /// An estimate of the irradiance on the side of n (zero: from all around), 0 where there can be none.
  float estimate(Normal n) const;

  LightSample sample(Vec2 u) const;
};

}  // namespace relume::transport
