// SPDX-License-Identifier: MIT
// The small stage that golden pictures show.
#pragma once
#include "hand_made.h"

namespace relume::picture {

/// A box with an open front; in it a block and a pane of coloured glass. Page 0 holds the floor and what
/// stands on it, page 1 the walls.
inline scene::Scene stage() {
  const scene::Material white = matte(Vec3(0.75f)), red = matte(Vec3(0.6f, 0.08f, 0.06f)),
                        green = matte(Vec3(0.1f, 0.45f, 0.1f));
  std::vector<Quad> quads = {
      {.corner = {-1, 0, 1}, .edge_u = {2, 0, 0}, .edge_v = {0, 0, -2}, .material = white},
      {.corner = {-1, 2, -1}, .edge_u = {2, 0, 0}, .edge_v = {0, 0, 2}, .material = white, .page = 1},
      {.corner = {-1, 0, -1}, .edge_u = {2, 0, 0}, .edge_v = {0, 2, 0}, .material = white, .page = 1},
      {.corner = {-1, 0, 1}, .edge_u = {0, 0, -2}, .edge_v = {0, 2, 0}, .material = red, .page = 1},
      {.corner = {1, 0, -1}, .edge_u = {0, 0, 2}, .edge_v = {0, 2, 0}, .material = green, .page = 1},
      {.corner = {0.1f, 0.1f, 0.6f},
       .edge_u = {0.7f, 0, 0},
       .edge_v = {0, 0.7f, 0.1f},
       .material = translucent(Vec3(0.1f, 0.3f, 0.8f), 0.5f),
       .page = scene::kNone},
  };
  const Vec3 corner(-0.6f, 0, 0.1f), x(0.5f, 0, 0.2f), z(-0.2f, 0, 0.5f), y(0, 0.9f, 0);
  const auto face = [&](Point at, Vec3 u, Vec3 v) {
    quads.push_back({.corner = at,
                     .edge_u = u,
                     .edge_v = v,
                     .material = white,
                     .uv_lo = Vec2(0.25f),
                     .uv_hi = Vec2(0.5f)});
  };
  face(corner + y, z, x);
  face(corner + z, x, y);
  face(corner + x, y, z);
  face(corner, z, y);
  face(corner, y, x);
  return sceneOf(quads);
}

/// Darker towards the page's edges, as corners are; a chart for each quarter of a page, one of them invalid.
inline asset::Asset stageBake() {
  constexpr int kSize = 16;
  asset::Asset bake = emptyBake(kSize, kSize, 2);
  std::vector<float> values, bent;
  for (std::uint32_t page = 0; page < 2; ++page)
    for (int y = 0; y < kSize; ++y)
      for (int x = 0; x < kSize; ++x) {
        const Vec2 p = (Vec2(x, y) + 0.5f) * 2.0f / static_cast<float>(kSize) - 1.0f;
        values.push_back((1 - 0.7f * p.x * p.x) * (1 - 0.7f * p.y * p.y));
        const Normal n = glm::normalize(Vec3(-p.x, 1.5f, p.y));
        bent.insert(bent.end(), {n.x, n.y, n.z});
        const auto entry = values.size() - 1;
        bake.atlas.chart[entry] = 4 * page + (x >= kSize / 2 ? 1u : 0u) + (y >= kSize / 2 ? 2u : 0u);
        bake.atlas.valid[entry] = x < 3 && y < 3 ? 0 : 1;
      }
  addLayer(bake, "obscurance", "value", values);
  bake.layers[0].planes.push_back({"bent", 3, asset::Storage::kFloat32, -1, 1, bent});
  return bake;
}

/// The same with relit irradiance, warm from the left and cold from the right, and a spectral W. For the
/// composition of [LPM] section 10.
inline asset::Asset stageRelitBake() {
  asset::Asset bake = stageBake();
  std::vector<float> irradiance, w;
  for (std::size_t i = 0; i < bake.atlas.texel.size(); ++i) {
    const float u = (static_cast<float>(i % 16) + 0.5f) / 16, v = bake.layers[0].planes[0].values[i];
    irradiance.insert(irradiance.end(), {1.2f - 0.8f * u, 0.7f, 0.3f + 0.8f * u});
    w.insert(w.end(), {std::min(1.0f, 1.3f * v), v, 0.8f * v});
  }
  addLayer(bake, "lightpath", "value", irradiance);
  addLayer(bake, "spectral", "value", w);
  return bake;
}

/// A square lamp under the ceiling and a candle on the floor.
inline LightSet stageLights() {
  Light lamp;
  lamp.kind = Light::Kind::kArea;
  lamp.position = {0, 1.95f, 0.2f};
  lamp.direction = {0, -1, 0};
  lamp.area = 0.2f;
  lamp.intensity = 25.0f;
  return {lamp, {.colour = {1, 0.6f, 0.3f}, .intensity = 1.2f, .position = {0.7f, 0.4f, -0.6f}}};
}

/// All terms of a relit picture at once.
inline PictureOptions composedStage() {
  PictureOptions options;
  options.width = 192, options.height = 144;
  options.view = View::kRelit;
  options.background = Vec3(0.1f);
  options.ambient = Irradiance(0.0f);
  options.lights = stageLights();
  options.obscurance = 1, options.bounce = 0.2f;
  return options;
}

inline Viewpoint stageView() { return lookAt({0.6f, 1.3f, 4.4f}, {0, 0.9f, 0}, 0.65f); }

}  // namespace relume::picture
