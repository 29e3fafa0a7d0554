// SPDX-License-Identifier: MIT
// Scenes with atlases made by hand, for tests of the texels.
#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "relume/atlas/atlas.h"

namespace relume::atlas::testing {

struct HandMade {
  scene::Scene scene;
  Atlas atlas;

  explicit HandMade(int size, std::uint32_t pages = 1) {
    atlas.width = atlas.height = size;
    atlas.pages = pages;
    scene::Material white;
    white.metallic = 0;
    scene.materials.push_back(white);
  }

  /// One instance. uv: per vertex, texels; chart: per triangle, numbered from 0 within this mesh.
  scene::Mesh& add(const std::vector<Point>& positions, const std::vector<Vec2>& uv,
                   const std::vector<UVec3>& triangles, const std::vector<std::uint32_t>& chart,
                   std::uint32_t page = 0) {
    scene::Mesh mesh;
    mesh.positions = positions;
    mesh.normals.assign(positions.size(), Normal(0, 0, 1));
    mesh.triangles = triangles;
    mesh.flat_normals = true;
    scene::Instance instance;
    instance.mesh = static_cast<std::uint32_t>(scene.meshes.size());
    InstanceUv map;
    map.instance = static_cast<std::uint32_t>(scene.instances.size());
    map.page = page;
    for (std::uint32_t v = 0; v < positions.size(); ++v) map.source_vertex.push_back(v);
    map.triangles = triangles;
    map.uv = uv;
    const auto first = static_cast<std::uint32_t>(atlas.charts.size());
    for (const std::uint32_t c : chart) {
      map.triangle_chart.push_back(c == scene::kNone ? c : first + c);
      while (c != scene::kNone && atlas.charts.size() <= first + c) {
        atlas.charts.push_back({map.instance, page, 0, 0, 0, 0, 1, 1});
      }
    }
    scene.meshes.push_back(mesh);
    scene.instances.push_back(instance);
    atlas.instances.push_back(map);
    return scene.meshes.back();
  }

  /// A parallelogram at `origin` with sides a and b; its page corner is `uv` and a, b run along x and y over
  /// `texels`.
  scene::Mesh& addQuad(Point origin, Vec3 a, Vec3 b, Vec2 uv, Vec2 texels, std::uint32_t page = 0) {
    return add({origin, origin + a, origin + a + b, origin + b},
               {uv, uv + Vec2(texels.x, 0), uv + texels, uv + Vec2(0, texels.y)}, {{0, 1, 2}, {0, 2, 3}},
               {0, 0}, page);
  }
};

}  // namespace relume::atlas::testing
