// SPDX-License-Identifier: MIT
// Everything in a scene that emits, in one table to sample light from: punctual lights, area lights (disks
// and polygons), suns (directional lights with an angular size), emissive triangles with their textures, the
// environment. Based on:
//   [RTR] Akenine-Moeller, Haines, Hoffman. Real-Time Rendering, 3rd ed. Section 11.1: emitted radiance L_e.
//   [CK18] Conty Estevez, Kulla. Importance Sampling of Many Lights with Adaptive Tree Splitting. HPG 2018.
//   [KHR] KHR_lights_punctual.
// What has a place and what is infinitely far away are sampled apart, because neither tells what the other is
// worth behind walls. Of the former one is chosen in proportion to an estimate of the irradiance that it
// gives (light_tree); of the latter half of the time by its irradiance and half of the time evenly, because
// none of this knows what is hidden. Then a direction: uniform in solid angle for triangles, polygons' too,
// and suns, in area for disks, by radiance for the environment. What holds: an emitter that can be hit by a
// ray has a pdf for it, so sampling of light and of directions combine (multiple importance sampling). Point
// and spot lights, and directional ones of no size, can only be sampled. Limits: disks and triangles of
// polygons are looked for one by one on every ray, meant for some tens of them. An emissive triangle is
// chosen by the mean of 32 look-ups of its texture.
#pragma once
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "relume/core/light.h"
#include "relume/scene/scene.h"

namespace relume::transport {

/// Light that may arrive at a point from one direction.
struct LightSample {
  Direction direction{0, 0, 1};  ///< to the light
  Point end{0};                  ///< where a shadow ray ends, just before the light; meaningless when endless
  bool endless = false;
  bool delta = false;  ///< of a light that no ray meets by chance
  /// Radiance; of a delta light the irradiance on a plane that faces it.
  Vec3 value{0.0f};
  /// Per steradian; of a delta light the probability of its choice. 0: no light from there.
  float pdf = 0.0f;
};

/// Light that a ray meets, and the density with which sample() of its kind would have chosen its direction.
struct LightSeen {
  Radiance radiance;
  float pdf = 0.0f;  ///< per steradian
};

enum class Reach : std::uint8_t {
  kLocal,    ///< point and spot lights, area lights, triangles
  kDistant,  ///< directional lights, the environment
};

enum class EmissiveSurfaces : std::uint8_t {
  kIncluded,
  kLeftOut,  ///< for who knows their light otherwise
};

class Emitters {
 public:
  /// Keeps a reference to `scene`, which must not change. `include_dynamic`: as the tracer was told. `group`:
  /// nothing shines but what belongs to that one of scene::lightGroups; empty: everything.
  explicit Emitters(const scene::Scene& scene, bool include_dynamic = false,
                    EmissiveSurfaces surfaces = EmissiveSurfaces::kIncluded, const std::string& group = {});
  ~Emitters();
  Emitters(Emitters&&) noexcept;

  /// Nothing emits.
  bool empty() const;
  std::size_t triangleCount() const;

  /// Whether there are emitters of that kind.
  bool has(Reach reach) const;

  /// Whether rays that hit this instance may see light there; whether rays may see light elsewhere (onRay).
  bool emits(std::uint32_t instance) const;
  bool seenBesideSurfaces() const;
  /// Whether such light can stand before a surface that a ray hits.
  bool seenBeforeSurfaces() const;

  /// Light of one kind at p from the side of n (unit; zero: from all around). u, choice in [0, 1). Visibility
  /// is left to the caller. All light is the sum of both kinds.
  LightSample sample(Reach reach, Point p, Normal n, Vec2 u, float choice) const;

  /// A ray from p (as above) along d meets a triangle at `hit`, `distance` metres away: what it emits towards
  /// p.
  LightSeen onSurface(Point p, Normal n, Direction d, const scene::Hit& hit, float distance,
                      bool back_face) const;
  /// Appends what a ray from p sees that is no surface: area lights between the distances `from` and `to`
  /// and, where it escapes (`to` is infinite), suns and environment.
  void onRay(Point p, Normal n, Direction d, float from, float to, std::vector<LightSeen>& seen) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace relume::transport
