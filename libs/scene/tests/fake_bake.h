// SPDX-License-Identifier: MIT
// A bake without light: enough to test that export carries one.
#pragma once
#include <cmath>

#include "relume/image/io.h"
#include "relume/scene/gltf.h"

namespace relume::scene::gltf {

struct FakeBake {
  bool split = true;        ///< every triangle gets vertices of its own; else the vertices of the mesh
  std::uint32_t pages = 1;  ///< instance i lies on page i % pages
  bool occlusion = true;
  bool lightmap = false;
  bool transfer = true;
};

/// Each static instance gets a row of the atlas; its vertices lie along a parabola there, so that all
/// coordinates differ.
inline BakeOutput fakeBake(const Scene& scene, const FakeBake& options = {}) {
  BakeOutput bake;
  const float rows = static_cast<float>(scene.instances.size());
  for (std::uint32_t i = 0; i < scene.instances.size(); ++i) {
    if (scene.instances[i].dynamic) continue;
    const Mesh& mesh = scene.meshes[scene.instances[i].mesh];
    AtlasUse use;
    use.instance = i;
    use.page = i % options.pages;
    if (options.split) {
      for (const UVec3 t : mesh.triangles) {
        const auto v = static_cast<std::uint32_t>(use.source_vertex.size());
        use.source_vertex.insert(use.source_vertex.end(), {t.x, t.y, t.z});
        use.triangles.emplace_back(v, v + 1, v + 2);
      }
    } else {
      use.triangles = mesh.triangles;
      for (std::uint32_t v = 0; v < mesh.positions.size(); ++v) use.source_vertex.push_back(v);
    }
    const float n = static_cast<float>(use.source_vertex.size());
    for (std::uint32_t v = 0; v < use.source_vertex.size(); ++v) {
      const float x = static_cast<float>(v) / n;
      use.uv.emplace_back(x, (static_cast<float>(i) + x * (1 - x)) / rows);
    }
    bake.uses.push_back(std::move(use));
  }
  if (options.occlusion)
    for (std::uint32_t p = 0; p < options.pages; ++p)
      bake.occlusion_png.push_back(image::encodePngData(image::Image(4, 4, 1, static_cast<float>(p) / 8)));
  if (options.lightmap)
    for (std::uint32_t p = 0; p < options.pages; ++p)
      bake.lightmap.push_back({image::encodePngData(image::Image(4, 4, 3, 1 - static_cast<float>(p) / 8)),
                               2.5f + static_cast<float>(p)});
  if (options.transfer) {
    bake.transfer = {
        {"layers", {{{"name", "ao"}, {"bufferView", 1}}, {{"name", "test"}, {"bufferView", 0}}}}};
    bake.views = {std::vector<std::byte>(5, std::byte{7}), std::vector<std::byte>(8, std::byte{9})};
  }
  return bake;
}

}  // namespace relume::scene::gltf
