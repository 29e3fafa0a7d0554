// SPDX-License-Identifier: MIT
// A scene with its atlas, its patches and their form factors.
#pragma once
#include <gtest/gtest.h>

#include <algorithm>
#include <span>
#include <utility>
#include <vector>

#include "made_rooms.h"
#include "radiosity/form_factors.h"
#include "relume/transport/lightmap.h"

namespace relume::transport::made {

struct Patched {
  explicit Patched(scene::Scene the_scene, int page_size = 64) : scene(std::move(the_scene)), tracer(scene) {
    Warnings warnings;
    SilentProgress silent;
    atlas = atlas::buildAtlas(scene, {.page_size = page_size}, warnings, silent);
    texels = atlas::rasterize(scene, atlas, silent);
  }

  Patches patches(std::uint32_t side) const {
    return makePatches(texels, side, std::vector<std::uint8_t>(texels.points.size(), 0));
  }
  FormFactors sampled(const Patches& patches, std::uint32_t rays) const {
    SilentProgress silent;
    const TexelLookup lookup(scene, atlas, texels);
    return sampledFormFactors({tracer, lookup, texels, patches}, rays, 1, silent);
  }
  FormFactors byHemicube(const Patches& patches, std::uint32_t resolution) const {
    SilentProgress silent;
    const TexelLookup lookup(scene, atlas, texels);
    return hemicubeFormFactors({tracer, lookup, texels, patches}, resolution, 1, silent);
  }
  std::uint32_t instanceOf(const Patches& patches, std::size_t patch) const {
    return texels.points[patches.membersOf(patch)[0]].instance;
  }
  /// From all patches of one instance to all of another.
  double between(const Patches& patches, const FormFactors& factors, std::uint32_t from,
                 std::uint32_t to) const {
    double sum = 0, area = 0;
    for (std::size_t i = 0; i < patches.size(); ++i) {
      if (instanceOf(patches, i) != from) continue;
      const auto own = static_cast<double>(patches.all[i].area);
      area += own;
      for (const FormFactors::Entry& e : factors.row(i))
        if (instanceOf(patches, e.patch) == to) sum += own * static_cast<double>(e.value);
    }
    return sum / area;
  }

  LightmapResult solve(const LightmapOptions& options) const {
    SilentProgress silent;
    return LightmapSolver(tracer, atlas, texels, options).solve(silent);
  }
  /// Only of texels within `radius` of one of the points; the others are 0.
  LightmapResult solveNear(const LightmapOptions& options, std::span<const Point> points,
                           float radius) const {
    std::vector<std::uint32_t> which;
    for (std::uint32_t i = 0; i < texels.points.size(); ++i)
      if (std::ranges::any_of(points,
                              [&](Point p) { return glm::length(texels.points[i].position - p) < radius; }))
        which.push_back(i);
    SilentProgress silent;
    const LightmapResult some = LightmapSolver(tracer, atlas, texels, options).solve(silent, which);
    LightmapResult all;
    all.value.resize(texels.points.size());
    for (std::size_t k = 0; k < which.size(); ++k) all.value[which[k]] = some.value[k];
    return all;
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

}  // namespace relume::transport::made
