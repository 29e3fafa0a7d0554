// SPDX-License-Identifier: MIT
// Where a bake is compared with its truth: places all over the surfaces.
#pragma once
#include <algorithm>
#include <cmath>
#include <vector>

#include "relume/picture/baked_values.h"
#include "relume/trace/tracer.h"
#include "verification.h"

namespace relume::app {

/// Places with equal shares of the baked area.
class SurfaceSampler {
 public:
  explicit SurfaceSampler(const scene::Scene& scene) : scene_(scene) {
    double area = 0;
    for (std::uint32_t i = 0; i < scene.instances.size(); ++i) {
      const scene::Mesh& mesh = scene.meshes[scene.instances[i].mesh];
      if (scene.instances[i].dynamic || mesh.atlas_page == scene::kNone) continue;
      for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
        const Point a = corner(i, t, 0, 0), b = corner(i, t, 1, 0), c = corner(i, t, 0, 1);
        area += 0.5 * static_cast<double>(glm::length(glm::cross(b - a, c - a)));
        triangles_.push_back({i, t});
        until_.push_back(area);
      }
    }
  }
  bool empty() const { return until_.empty() || !(until_.back() > 0); }
  /// share, u in [0, 1).
  scene::Hit at(double share, Vec2 u) const {
    const auto found = std::upper_bound(until_.begin(), until_.end(), share * until_.back());
    const auto k = std::min(static_cast<std::size_t>(found - until_.begin()), until_.size() - 1);
    const float root = std::sqrt(u.x);
    return {triangles_[k].instance, triangles_[k].triangle, root * (1 - u.y), root * u.y};
  }

 private:
  Point corner(std::uint32_t instance, std::uint32_t triangle, float b1, float b2) const {
    return scene::worldPosition(scene_, {instance, triangle, b1, b2});
  }
  struct Triangle {
    std::uint32_t instance, triangle;
  };
  const scene::Scene& scene_;
  std::vector<Triangle> triangles_;
  std::vector<double> until_;  // area up to and with each
};

struct VerifiedPlace {
  scene::Hit hit;
  double baked = 0;  ///< luminance of the baked value, read as a viewer does
};

/// options.points places with equal shares of the baked area, less those that have no single truth (buried,
/// cut out by alpha, where two surfaces coincide), which are counted in `skipped`.
std::vector<VerifiedPlace> choosePlaces(const trace::Tracer& tracer, const picture::BakedValues& baked,
                                        const VerifyOptions& options, std::size_t& skipped);

}  // namespace relume::app
