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

}  // namespace relume::picture
