// SPDX-License-Identifier: MIT
// A scene with its atlas, and lightmaps of it, for tests.
#pragma once
#include <gtest/gtest.h>

#include <algorithm>
#include <utility>

#include "relume/scene/scene.h"
#include "relume/transport/lightmap.h"

namespace relume::transport::made {

/// A scene with its atlas, and lightmaps of it.
struct Lit {
  explicit Lit(scene::Scene the_scene, int page_size = 64) : scene(std::move(the_scene)), tracer(scene) {
    Warnings warnings;
    SilentProgress silent;
    atlas = atlas::buildAtlas(scene, {.page_size = page_size}, warnings, silent);
    texels = atlas::rasterize(scene, atlas, silent);
  }
  LightmapResult solve(const LightmapOptions& options, std::span<const std::uint32_t> which = {}) const {
    SilentProgress silent;
    return LightmapSolver(tracer, atlas, texels, options).solve(silent, which);
  }
  /// Area-weighted, of one instance or of all.
  glm::dvec3 mean(const LightmapResult& result, std::uint32_t instance = scene::kNone) const {
    glm::dvec3 sum(0);
    double area = 0;
    for (std::size_t i = 0; i < texels.points.size(); ++i) {
      const atlas::SurfacePoint& p = texels.points[i];
      if (instance != scene::kNone && p.instance != instance) continue;
      sum += static_cast<double>(p.area) * glm::dvec3(result.value[i].rgb),
          area += static_cast<double>(p.area);
    }
    return sum / area;
  }
  /// Mean of the texels that face n and whose middles lie within `radius` of p.
  glm::dvec3 about(const LightmapResult& result, Point p, Normal n, float radius) const {
    glm::dvec3 sum(0);
    int count = 0;
    for (std::size_t i = 0; i < texels.points.size(); ++i)
      if (glm::length(texels.points[i].position - p) < radius &&
          glm::dot(texels.points[i].geometric_normal, n) > 0.99f)
        sum += glm::dvec3(result.value[i].rgb), ++count;
    EXPECT_GT(count, 0) << "no texel there";
    return sum / std::max<double>(count, 1);
  }
  scene::Scene scene;
  trace::Tracer tracer;
  atlas::Atlas atlas;
  atlas::Texels texels;
};

inline void expectNear(glm::dvec3 value, glm::dvec3 expected, double relative, const char* what = "") {
  for (int c = 0; c < 3; ++c)
    EXPECT_NEAR(value[c], expected[c], relative * expected[c]) << what << " channel " << c;
}

inline LightmapOptions plain(std::uint32_t samples) {
  return {.materials = Materials::kLambert, .min_samples = samples, .max_samples = samples};
}

}  // namespace relume::transport::made
