// SPDX-License-Identifier: MIT
// All that shines in a scene as a source of paths, chosen in proportion to power.
#pragma once
#include <cstdint>
#include <vector>

#include "environment_sampler.h"
#include "light_shapes.h"
#include "relume/scene/scene.h"
#include "relume/trace/tracer.h"

namespace relume::transport {

/// The beginning of a path.
struct Photon {
  trace::Ray ray;
  Vec3 power{0.0f};         ///< W, of the whole scene: this path's share divided by its probability
  float range = kInfinity;  ///< metres: KHR_lights_punctual's window ends there
};

class PhotonSource {
 public:
  /// Keeps a reference to `scene`.
  explicit PhotonSource(const scene::Scene& scene);

  /// Luminance of all power, as estimated for the choice, W; 0: nothing shines.
  double power() const { return emitters_.empty() ? 0.0 : cumulative_.back(); }
  /// Numbers in [0, 1).
  Photon emit(Vec2 choice, Vec2 place, Vec2 direction) const;

 private:
  enum class Kind : std::uint8_t { kPunctual, kDisk, kPanel, kTriangle, kSun, kEnvironment };
  struct Emitter {
    Kind kind;
    std::uint32_t index;     // of the kind's list; of triangles their instance
    std::uint32_t triangle;  // of the instance's mesh
  };
  void add(Emitter emitter, float power);
  void addLights();
  void addTriangles();
  Photon fromPunctual(const Light& light, Vec2 direction) const;
  /// A place on something that shines, and the area that it was chosen from.
  struct Place {
    Point position;
    Normal normal;
    Vec3 radiance;
    float area;
    bool two_sided;
  };
  /// Cosine-weighted; `side` in [0, 1) chooses one where there are two.
  Photon fromArea(const Place& from, float side, Vec2 direction) const;
  Photon fromTriangle(const Emitter& emitter, Vec2 place, float side, Vec2 direction) const;
  Photon fromAfar(Direction to_light, Vec3 irradiance, Vec2 place) const;

  const scene::Scene& scene_;
  EnvironmentSampler environment_;
  Point centre_{0};
  float radius_ = 0;  // of a ball about the scene
  std::vector<Disk> disks_;
  std::vector<Panel> panels_;
  std::vector<Sun> suns_;
  std::vector<Emitter> emitters_;
  std::vector<double> cumulative_;  // of power
};

}  // namespace relume::transport
