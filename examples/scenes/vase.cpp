// SPDX-License-Identifier: MIT
// A vase with a metal ball in its mouth: something to be carried through other scenes (relume render
// --object).
#include <cmath>

#include "scenes.h"
#include "shapes.h"

namespace relume::scenes {

GlbScene makeVase(int detail) {
  GlbScene scene("vase");
  const auto clay =
      scene.addMaterial({.name = "clay", .base_colour = {0.8f, 0.78f, 0.72f}, .roughness = 0.8f});
  const auto metal = scene.addMaterial(
      {.name = "metal", .base_colour = {0.95f, 0.9f, 0.8f}, .roughness = 0.25f, .metallic = 1});
  MeshBuilder body, ball;
  body.material(clay), ball.material(metal);
  // From the outside of the foot up to the rim; closed below and above.
  std::vector<P2> profile = {{0, 0}, {0.2, 0}};
  for (int i = 0; i <= 12 * detail; ++i) {
    const double t = i / (12.0 * detail), y = 1.1 * t;
    profile.emplace_back(
        0.2 + 0.16 * std::sin(kTau / 2 * std::min(1.0, t / 0.75)) - 0.06 * std::max(0.0, t - 0.6) / 0.4, y);
  }
  profile.emplace_back(0.0, 1.1);
  std::vector<P2> arc;
  for (int i = 0; i <= 10 * detail; ++i) {
    const double a = kTau / 2 * (i / (10.0 * detail) - 0.5);
    arc.emplace_back(0.2 * std::cos(a), 1.26 + 0.2 * std::sin(a));
  }
  lathe(body, profile, 16 * detail);
  lathe(ball, arc, 16 * detail);
  scene.place("vase", scene.addMesh("vase", body));
  scene.place("ball", scene.addMesh("ball", ball));
  scene.addCamera("front", {0, 1.0, 3.0}, {0, 0.6, 0}, 40);
  scene.note("to be put into other scenes");
  return scene;
}

}  // namespace relume::scenes
