// SPDX-License-Identifier: MIT
// The Cornell box: coordinates of Cornell University's "Cornell Box Data" page (millimetres there; the room
// is 5.55 m wide here, ten times the real box), reflectances as the usual Rec. 709 values of the measured
// spectra. The light fills a hole of the ceiling; the blocks have no bottom.
#include "scenes.h"

namespace relume::scenes {
namespace {

P3 cm(double x, double y, double z) { return P3(x, y, z) / 100.0; }

// A block stands on the floor: four corners of its top, counter-clockwise seen from above.
void block(MeshBuilder& mesh, const P3 (&top)[4]) {
  mesh.quad(top[0], top[1], top[2], top[3]);
  for (int i = 0; i < 4; ++i) {
    const P3 a = top[i], b = top[(i + 1) % 4];
    mesh.quad(b, a, {a.x, 0, a.z}, {b.x, 0, b.z});
  }
}

}  // namespace

GlbScene makeCornell(int) {
  GlbScene scene("Cornell box");
  const auto white =
      scene.addMaterial({.name = "white", .base_colour = {0.725f, 0.71f, 0.68f}, .roughness = 1.0f});
  const auto red =
      scene.addMaterial({.name = "red", .base_colour = {0.63f, 0.065f, 0.05f}, .roughness = 1.0f});
  const auto green =
      scene.addMaterial({.name = "green", .base_colour = {0.14f, 0.45f, 0.091f}, .roughness = 1.0f});
  const auto light = scene.addMaterial({.name = "light",
                                        .base_colour = {0.78f, 0.78f, 0.78f},
                                        .roughness = 1.0f,
                                        .emission = {17.0f, 12.0f, 4.0f}});

  MeshBuilder room;
  room.material(white);
  room.quad(cm(552.8, 0, 0), cm(0, 0, 0), cm(0, 0, 559.2), cm(549.6, 0, 559.2));
  room.quad(cm(549.6, 0, 559.2), cm(0, 0, 559.2), cm(0, 548.8, 559.2), cm(556, 548.8, 559.2));
  room.material(green);
  room.quad(cm(0, 0, 559.2), cm(0, 0, 0), cm(0, 548.8, 0), cm(0, 548.8, 559.2));
  room.material(red);
  room.quad(cm(552.8, 0, 0), cm(549.6, 0, 559.2), cm(556, 548.8, 559.2), cm(556, 548.8, 0));
  // The ceiling around the light, as a frame of four.
  const P3 outer[4] = {cm(556, 548.8, 0), cm(556, 548.8, 559.2), cm(0, 548.8, 559.2), cm(0, 548.8, 0)};
  const P3 inner[4] = {cm(343, 548.8, 227), cm(343, 548.8, 332), cm(213, 548.8, 332), cm(213, 548.8, 227)};
  room.material(white);
  for (int i = 0; i < 4; ++i) room.quad(outer[i], outer[(i + 1) % 4], inner[(i + 1) % 4], inner[i]);
  scene.place("room", scene.addMesh("room", room));

  MeshBuilder lamp;
  lamp.material(light);
  lamp.quad(inner[0], inner[1], inner[2], inner[3]);
  scene.place("light", scene.addMesh("light", lamp));

  MeshBuilder short_block, tall_block;
  short_block.material(white), tall_block.material(white);
  block(short_block, {cm(130, 165, 65), cm(82, 165, 225), cm(240, 165, 272), cm(290, 165, 114)});
  block(tall_block, {cm(423, 330, 247), cm(265, 330, 296), cm(314, 330, 456), cm(472, 330, 406)});
  scene.place("short block", scene.addMesh("short block", short_block));
  scene.place("tall block", scene.addMesh("tall block", tall_block));

  scene.addCamera("front", cm(278, 273, -800), cm(278, 273, 0), 39.3076);
  scene.addCamera("corner", cm(90, 440, -120), cm(330, 120, 330), 55);
  scene.note("Cornell box, published coordinates, one unit taken as a centimetre");
  return scene;
}

}  // namespace relume::scenes
