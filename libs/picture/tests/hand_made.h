// SPDX-License-Identifier: MIT
// Scenes and bakes by hand, small enough that every pixel is known.
#pragma once
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "relume/asset/asset.h"
#include "relume/picture/picture.h"
#include "relume/scene/scene.h"
#include "relume/trace/tracer.h"

namespace relume::picture {

inline scene::Material matte(Vec3 albedo) {
  scene::Material material;
  material.base_colour = Vec4(albedo, 1.0f);
  material.metallic = 0.0f;
  return material;
}

inline scene::Material translucent(Vec3 albedo, float opacity) {
  scene::Material material = matte(albedo);
  material.base_colour.a = opacity;
  material.alpha_mode = scene::AlphaMode::kBlend;
  return material;
}

/// Corner, and the two edges that leave it; the normal is edge_u x edge_v. TEXCOORD_1 runs along the edges
/// over `page`.
struct Quad {
  Point corner{0.0f};
  Vec3 edge_u{1, 0, 0}, edge_v{0, 1, 0};
  scene::Material material = matte(Vec3(1.0f));
  std::uint32_t page = 0;  ///< scene::kNone: not baked
  bool dynamic = false;
  Vec2 uv_lo{0.0f}, uv_hi{1.0f};
};

inline scene::Scene sceneOf(const std::vector<Quad>& quads) {
  scene::Scene s;
  s.name = "quads";
  for (const Quad& q : quads) {
    const auto index = static_cast<std::uint32_t>(s.meshes.size());
    scene::Mesh& m = s.meshes.emplace_back();
    m.name = "quad " + std::to_string(index);
    m.positions = {q.corner, q.corner + q.edge_u, q.corner + q.edge_u + q.edge_v, q.corner + q.edge_v};
    m.normals.assign(4, glm::normalize(glm::cross(q.edge_u, q.edge_v)));
    m.triangles = {{0, 1, 2}, {0, 2, 3}};
    m.uv[1] = {q.uv_lo, {q.uv_hi.x, q.uv_lo.y}, q.uv_hi, {q.uv_lo.x, q.uv_hi.y}};
    m.material = index;
    m.atlas_page = q.page;
    s.materials.push_back(q.material);
    scene::Instance instance;
    instance.name = m.name;
    instance.mesh = index;
    instance.dynamic = q.dynamic;
    s.instances.push_back(instance);
  }
  s.materials.push_back(matte(Vec3(0.8f)));
  return s;
}

/// A unit ball of flat triangles with the normals of a round one. TEXCOORD_1 is (0, 0) throughout.
inline scene::Scene ball(std::uint32_t rings, std::uint32_t sectors) {
  scene::Scene s = sceneOf({{}});
  scene::Mesh& m = s.meshes[0];
  m.positions.clear();
  m.triangles.clear();
  for (std::uint32_t ring = 0; ring <= rings; ++ring)
    for (std::uint32_t sector = 0; sector <= sectors; ++sector) {
      const float theta = kPi * static_cast<float>(ring) / static_cast<float>(rings);
      const float phi = 2 * kPi * static_cast<float>(sector) / static_cast<float>(sectors);
      m.positions.push_back(
          {std::sin(theta) * std::cos(phi), std::cos(theta), std::sin(theta) * std::sin(phi)});
      if (ring == rings || sector == sectors) continue;
      const std::uint32_t a = ring * (sectors + 1) + sector, b = a + sectors + 1;
      m.triangles.push_back({a, a + 1, b});
      m.triangles.push_back({b, a + 1, b + 1});
    }
  m.normals = m.positions;
  m.uv[1].assign(m.positions.size(), Vec2(0.0f));
  return s;
}

/// A bake in which every texel is covered, valid and of chart 0, without layers.
inline asset::Asset emptyBake(int width, int height, std::uint32_t pages = 1) {
  asset::Asset bake;
  bake.atlas.width = width;
  bake.atlas.height = height;
  bake.atlas.pages = pages;
  const auto texels = pages * static_cast<std::uint32_t>(width * height);
  for (std::uint32_t i = 0; i < texels; ++i) bake.atlas.texel.push_back(i);
  bake.atlas.position.resize(texels);
  bake.atlas.normal.resize(texels);
  bake.atlas.albedo.resize(texels);
  bake.atlas.valid.assign(texels, 1);
  bake.atlas.chart.assign(texels, 0);
  return bake;
}

inline void addLayer(asset::Asset& bake, const std::string& kind, const std::string& plane,
                     std::vector<float> values) {
  asset::Layer& layer = bake.layers.emplace_back();
  layer.name = layer.kind = kind;
  const std::size_t texels = bake.atlas.texel.size();
  layer.planes.push_back(
      {plane, static_cast<int>(values.size() / texels), asset::Storage::kFloat32, 0, 1, std::move(values)});
}

/// A bake of one page whose obscurance is `w` everywhere.
inline asset::Asset constantBake(float w) {
  asset::Asset bake = emptyBake(4, 4);
  addLayer(bake, "obscurance", "value", std::vector<float>(16, w));
  return bake;
}

/// Looks down -z at the square [0, side]^2 of the plane z = 0, which fills the picture; x to the right, y up.
inline Viewpoint squareOn(float side, float height = 10.0f) {
  Viewpoint view = lookAt({side / 2, side / 2, height}, {side / 2, side / 2, 0}, 0.8f);
  view.ortho_height = side;
  return view;
}

/// Looks down -z at the middle of the unit square of the plane z = 0.
inline Viewpoint middle(float side = 0.25f) {
  Viewpoint view = lookAt({0.5f, 0.5f, 10}, {0.5f, 0.5f, 0}, 0.8f);
  view.ortho_height = side;
  return view;
}

inline PictureOptions optionsOf(View view, int size = 1, int samples = 1) {
  PictureOptions options;
  options.view = view;
  options.width = options.height = size;
  options.samples = samples;
  return options;
}

inline image::Image rendered(const scene::Scene& scene, const asset::Asset* bake, const Viewpoint& view,
                             const PictureOptions& options) {
  trace::TracerOptions tracing;
  tracing.include_dynamic = true;
  const trace::Tracer tracer(scene, tracing);
  SilentProgress silent;
  return render(tracer, bake, view, options, silent);
}

/// The colour of a picture of one pixel.
inline Vec3 onePixel(const scene::Scene& scene, const asset::Asset* bake, const Viewpoint& view,
                     PictureOptions options) {
  options.width = options.height = 1;
  return rendered(scene, bake, view, options).rgb(0, 0);
}

inline void expectNear(Vec3 value, Vec3 expected, float allowed) {
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(value[c], expected[c], allowed) << "channel " << c;
}

}  // namespace relume::picture
