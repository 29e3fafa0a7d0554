// SPDX-License-Identifier: MIT
// A room after the figure of Hey and Purgathofer's paper on directional light maps (2002): lamps light
// nothing but the ceiling and the back wall; floor, table and chairs gleam softly, as Phong's exponent 10
// does, which is a highlight as wide as that of roughness 0.473: exponent = 1 / (2 roughness^4).
#include "scenes.h"
#include "shapes.h"

namespace relume::scenes {
namespace {

constexpr float kRoughness = 0.473f;
constexpr double kWidth = 6, kHeight = 3, kDepth = 5;

void tableInto(MeshBuilder& mesh) {
  box(mesh, {-0.9, 0.71, -0.5}, {0.9, 0.75, 0.5}, 0.008);
  for (const double x : {-0.82, 0.76})
    for (const double z : {-0.42, 0.36}) box(mesh, {x, 0, z}, {x + 0.06, 0.71, z + 0.06}, 0.006, kYLo | kYHi);
}

/// Its back is at -z.
void chairInto(MeshBuilder& mesh) {
  box(mesh, {-0.22, 0.42, -0.22}, {0.22, 0.46, 0.22}, 0.008);
  box(mesh, {-0.22, 0.46, -0.22}, {0.22, 0.92, -0.18}, 0.008, kYLo);
  for (const double x : {-0.2, 0.16})
    for (const double z : {-0.2, 0.16}) box(mesh, {x, 0, z}, {x + 0.04, 0.42, z + 0.04}, 0.005, kYLo | kYHi);
}

}  // namespace

GlbScene makeGlossyRoom(int) {
  GlbScene scene("glossy room");
  const auto plaster =
      scene.addMaterial({.name = "plaster", .base_colour = {0.75f, 0.73f, 0.68f}, .roughness = 1.0f});
  const auto blue =
      scene.addMaterial({.name = "blue wall", .base_colour = {0.25f, 0.36f, 0.55f}, .roughness = 1.0f});
  const auto warm =
      scene.addMaterial({.name = "ochre wall", .base_colour = {0.68f, 0.45f, 0.2f}, .roughness = 1.0f});
  const auto floor = scene.addMaterial(
      {.name = "floor", .base_colour = {0.55f, 0.42f, 0.3f}, .roughness = kRoughness, .metallic = 0.6f});
  const auto table = scene.addMaterial(
      {.name = "table", .base_colour = {0.6f, 0.25f, 0.12f}, .roughness = kRoughness, .metallic = 0.5f});
  const auto chair = scene.addMaterial(
      {.name = "chair", .base_colour = {0.25f, 0.5f, 0.3f}, .roughness = kRoughness, .metallic = 0.5f});

  const P3 p[8] = {{0, 0, 0},       {kWidth, 0, 0},       {kWidth, 0, kDepth},       {0, 0, kDepth},
                   {0, kHeight, 0}, {kWidth, kHeight, 0}, {kWidth, kHeight, kDepth}, {0, kHeight, kDepth}};
  MeshBuilder room;
  room.material(floor);
  room.quad(p[3], p[2], p[1], p[0]);
  room.material(plaster);
  room.quad(p[4], p[5], p[6], p[7]);
  room.quad(p[0], p[1], p[5], p[4]);
  room.quad(p[2], p[3], p[7], p[6]);
  room.material(blue);
  room.quad(p[3], p[0], p[4], p[7]);
  room.material(warm);
  room.quad(p[1], p[2], p[6], p[5]);
  scene.place("room", scene.addMesh("room", room));

  MeshBuilder t, c;
  t.material(table), c.material(chair);
  tableInto(t), chairInto(c);
  scene.place("table", scene.addMesh("table", t), {.position = {3, 0, 2.3}});
  const auto chair_mesh = scene.addMesh("chair", c);
  scene.place("chair 1", chair_mesh, {.position = {2.5, 0, 1.65}});
  scene.place("chair 2", chair_mesh, {.position = {3.5, 0, 1.55}, .turn_y = 0.2});
  scene.place("chair 3", chair_mesh, {.position = {4.25, 0, 2.4}, .turn_y = -1.7});
  scene.place("chair 4", chair_mesh, {.position = {1.6, 0, 2.9}, .turn_y = 2.2});

  const auto up = scene.addLight({.name = "uplight",
                                  .type = "spot",
                                  .colour = {1.0f, 0.93f, 0.82f},
                                  .intensity = 20,
                                  .group = "ceiling",
                                  .inner_cone = 0.5,
                                  .outer_cone = 0.8});
  const auto wash = scene.addLight({.name = "wall washer",
                                    .type = "spot",
                                    .colour = {1.0f, 0.97f, 0.92f},
                                    .intensity = 40,
                                    .group = "back wall",
                                    .inner_cone = 0.3,
                                    .outer_cone = 0.45});
  for (const double x : {1.6, 4.4})
    for (const double z : {1.7, 3.4}) scene.placeLight("uplight", up, {x, 1.5, z}, {x, kHeight, z});
  for (const double x : {1.3, 3.0, 4.7}) scene.placeLight("wall washer", wash, {x, 2.0, 2.5}, {x, 1.75, 0});

  scene.addCamera("door", {3.6, 1.6, 4.8}, {2.9, 0.7, 1.0}, 55);
  scene.addCamera("corner", {0.4, 1.7, 4.6}, {4.2, 0.4, 1.2}, 55);
  scene.note("after the figure of 'Directional Light Maps' (Hey, Purgathofer 2002)");
  return scene;
}

}  // namespace relume::scenes
