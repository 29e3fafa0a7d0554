// SPDX-License-Identifier: MIT
// A scene with its atlas, its patches and their form factors.
#pragma once
#include <algorithm>
#include <span>
#include <vector>

#include "lit_scene.h"
#include "made_rooms.h"
#include "radiosity/form_factors.h"
#include "relume/transport/lightmap.h"

namespace relume::transport::made {

struct Patched : Lit {
  using Lit::Lit;

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

  /// Only of texels within `radius` of one of the points; the others are 0.
  LightmapResult solveNear(const LightmapOptions& options, std::span<const Point> points,
                           float radius) const {
    std::vector<std::uint32_t> which;
    for (std::uint32_t i = 0; i < texels.points.size(); ++i)
      if (std::ranges::any_of(points,
                              [&](Point p) { return glm::length(texels.points[i].position - p) < radius; }))
        which.push_back(i);
    const LightmapResult some = solve(options, which);
    LightmapResult all;
    all.value.resize(texels.points.size());
    for (std::size_t k = 0; k < which.size(); ++k) all.value[which[k]] = some.value[k];
    return all;
  }
};

}  // namespace relume::transport::made
