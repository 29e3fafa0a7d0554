// SPDX-License-Identifier: MIT
// A corner of a courtyard: cobbles, two brick walls, a plinth. All relief is in height maps; the mesh is
// flat.
#include <cmath>
#include <string>

#include "picture.h"
#include "scenes.h"
#include "shapes.h"

namespace relume::scenes {

GlbScene makeCourtyard(int detail) {
  GlbScene scene("courtyard");
  const auto cobbles = reliefOf(ReliefPattern::kCobbles), bricks = reliefOf(ReliefPattern::kBricks);
  const auto with_relief = [&](const char* name, const ReliefPictures& pictures, float roughness,
                               double scale) {
    const auto colours = scene.addTexture(std::string(name) + " colours", pictures.colours);
    const auto heights = scene.addTexture(std::string(name) + " heights", pictures.heights);
    return scene.addMaterial({.name = name,
                              .base_colour = Vec3(1.0f),
                              .roughness = roughness,
                              .texture = colours,
                              .height = heights,
                              .height_scale = scale});
  };
  const auto floor = with_relief("cobbles", cobbles, 0.7f, 0.06),
             wall = with_relief("bricks", bricks, 0.9f, 0.035);
  const auto stone =
      scene.addMaterial({.name = "stone", .base_colour = {0.7f, 0.67f, 0.6f}, .roughness = 0.8f});

  constexpr double kSide = 4, kHeight = 2.6;
  MeshBuilder ground, walls;
  ground.material(floor);
  ground.uv([](P3 p) { return P2(p.x, p.z); });
  ground.quad({0, 0, kSide}, {kSide, 0, kSide}, {kSide, 0, 0}, {0, 0, 0});
  walls.material(wall);
  walls.uv([](P3 p) { return P2(p.x + p.z, kHeight - p.y); });
  walls.quad({0, 0, 0}, {kSide, 0, 0}, {kSide, kHeight, 0}, {0, kHeight, 0});
  walls.quad({0, 0, kSide}, {0, 0, 0}, {0, kHeight, 0}, {0, kHeight, kSide});
  scene.place("ground", scene.addMesh("ground", ground));
  scene.place("walls", scene.addMesh("walls", walls));

  MeshBuilder plinth;
  plinth.material(stone);
  box(plinth, {-0.3, 0, -0.3}, {0.3, 0.7, 0.3}, 0.02, kYLo);
  std::vector<P2> ball;
  for (int i = 0; i <= 8 * detail; ++i) {
    const double a = kTau / 2 * (i / (8.0 * detail) - 0.5);
    ball.emplace_back(0.26 * std::cos(a), 0.96 + 0.26 * std::sin(a));
  }
  lathe(plinth, ball, 16 * detail);
  scene.place("plinth", scene.addMesh("plinth", plinth), {.position = {1.5, 0, 1.4}});

  const auto sun = scene.addLight(
      {.name = "low sun", .type = "directional", .colour = {1.0f, 0.9f, 0.75f}, .intensity = 7});
  scene.placeLight("low sun", sun, {4, 2.6, 1.9}, {0, 0.4, 0.9});
  const auto lamp =
      scene.addLight({.name = "lamp", .type = "point", .colour = {1.0f, 0.8f, 0.55f}, .intensity = 2});
  scene.placeLight("lamp", lamp, {0.5, 1.9, 0.7});
  scene.addCamera("corner", {3.5, 1.35, 3.5}, {0.9, 0.6, 0.9}, 50);
  scene.addCamera("close", {2.3, 0.5, 2.7}, {1.2, 0.15, 1.1}, 45);
  scene.note("relief by height maps: relume render --renderer gl --materials full");
  return scene;
}

}  // namespace relume::scenes
