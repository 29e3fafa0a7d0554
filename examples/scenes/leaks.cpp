// SPDX-License-Identifier: MIT
// Four rooms in which lightmaps are prone to leak or to darken at rims: docs/leaks.md shows them. Faces that
// end on others do so flush, with equal coordinates and no common vertex, as in scenes that people make.
#include "scenes.h"
#include "shapes.h"

namespace relume::scenes {
namespace {

constexpr Vec3 kWhite{0.75f, 0.75f, 0.75f};

std::uint32_t plain(GlbScene& scene, const char* name, Vec3 colour, bool double_sided = false) {
  return scene.addMaterial(
      {.name = name, .base_colour = colour, .roughness = 1.0f, .double_sided = double_sided});
}

std::uint32_t lamp(GlbScene& scene, float radiance) {
  return scene.addMaterial({.name = "lamp",
                            .base_colour = Vec3(0.0f),
                            .roughness = 1.0f,
                            .emission = radiance * Vec3(1.0f, 0.86f, 0.7f)});
}

/// A box seen from within.
MeshBuilder shell(std::uint32_t material, P3 lo, P3 hi) {
  MeshBuilder room;
  room.material(material);
  const auto at = [&](int x, int y, int z) { return P3(x ? hi.x : lo.x, y ? hi.y : lo.y, z ? hi.z : lo.z); };
  room.quad(at(0, 0, 0), at(0, 0, 1), at(1, 0, 1), at(1, 0, 0));
  room.quad(at(0, 1, 0), at(1, 1, 0), at(1, 1, 1), at(0, 1, 1));
  room.quad(at(0, 0, 0), at(1, 0, 0), at(1, 1, 0), at(0, 1, 0));
  room.quad(at(0, 0, 1), at(0, 1, 1), at(1, 1, 1), at(1, 0, 1));
  room.quad(at(0, 0, 0), at(0, 1, 0), at(0, 1, 1), at(0, 0, 1));
  room.quad(at(1, 0, 0), at(1, 0, 1), at(1, 1, 1), at(1, 1, 0));
  return room;
}

/// A panel under a ceiling that shines downwards.
void placePanel(GlbScene& scene, std::uint32_t material, P3 middle, double half_side) {
  MeshBuilder panel;
  panel.material(material);
  const double s = half_side;
  panel.quad({-s, 0, -s}, {s, 0, -s}, {s, 0, s}, {-s, 0, s});
  scene.place("panel", scene.addMesh("panel", panel), {.position = middle});
}

void placeBox(GlbScene& scene, const char* name, std::uint32_t material, P3 lo, P3 hi,
              const M4& move = M4(1.0)) {
  MeshBuilder body, moved;
  body.material(material);
  box(body, lo, hi);
  moved.append(body, move);
  scene.place(name, scene.addMesh(name, moved));
}

void table(MeshBuilder& mesh, P3 middle, double width, double depth, double height) {
  constexpr double kTop = 0.03, kLeg = 0.05, kInset = 0.04;
  const P3 half(width / 2, 0, depth / 2);
  box(mesh, middle - half + P3(0, height - kTop, 0), middle + half + P3(0, height, 0));
  for (int i = 0; i < 4; ++i) {
    const double x = i & 1 ? half.x - kInset - kLeg : -half.x + kInset,
                 z = i & 2 ? half.z - kInset - kLeg : -half.z + kInset;
    const P3 foot = middle + P3(x, 0, z);
    box(mesh, foot, foot + P3(kLeg, height - kTop, kLeg), 0.0, kYHi);
  }
}

/// A sphere of light on a thin stand, within a shade that is open at both ends.
void placeTableLamp(GlbScene& scene, const std::string& name, std::uint32_t metal, std::uint32_t light,
                    std::uint32_t shade, P3 foot, bool two_walls) {
  MeshBuilder stand, bulb, cover;
  stand.material(metal), bulb.material(light), cover.material(shade);
  lathe(stand, {{0.0, 0.0}, {0.07, 0.0}, {0.07, 0.015}, {0.01, 0.02}, {0.01, 0.22}, {0.0, 0.22}}, 16);
  std::vector<P2> profile;
  for (int i = 0; i <= 8; ++i) {
    const double a = kTau / 2 * (i / 8.0 - 0.5);
    profile.emplace_back(0.035 * std::cos(a), 0.255 + 0.035 * std::sin(a));
  }
  profile.front().x = profile.back().x = 0.0;
  lathe(bulb, profile, 16);
  std::vector<P2> wall = {{0.16, 0.15}, {0.11, 0.38}};
  if (two_walls) wall = {{0.16, 0.15}, {0.11, 0.38}, {0.108, 0.38}, {0.158, 0.15}, {0.16, 0.15}};
  lathe(cover, wall, 32);
  scene.place(name + " stand", scene.addMesh(name + " stand", stand), {.position = foot});
  scene.place(name + " bulb", scene.addMesh(name + " bulb", bulb), {.position = foot});
  scene.place(name + " shade", scene.addMesh(name + " shade", cover), {.position = foot});
}

}  // namespace

GlbScene makeRooms(int) {
  GlbScene scene("three rooms");
  const auto white = plain(scene, "white", kWhite), sheet = plain(scene, "sheet", kWhite, true);
  // Floor, ceiling and long walls run through all three rooms.
  const P3 lo(-4, 0, -1.5), hi(4, 2.5, 1.5);
  scene.place("shell", scene.addMesh("shell", shell(white, lo, hi)));
  MeshBuilder wall, curtain;
  wall.material(white);
  box(wall, {-1.23, 0, -1.5}, {-1.21, 2.5, 1.5}, 0.0, kYLo | kYHi | kZLo | kZHi);
  scene.place("wall", scene.addMesh("wall", wall));
  curtain.material(sheet);
  curtain.quad({1.23, 0, -1.5}, {1.23, 0, 1.5}, {1.23, 2.5, 1.5}, {1.23, 2.5, -1.5});
  scene.place("sheet", scene.addMesh("sheet", curtain));
  placePanel(scene, lamp(scene, 20.0f), {0, 2.48, 0}, 0.3);
  scene.addCamera("over the wall", {-3.1, 1.7, 1.3}, {-1.2, 0.2, -0.6}, 60);
  scene.addCamera("lit room", {-0.9, 1.6, 1.3}, {0.4, 0.9, -1.2}, 70);
  scene.addCamera("behind the sheet", {3.6, 1.5, 1.2}, {1.2, 0.3, -0.6}, 60);
  scene.note("a lit room between two dark ones: behind a wall of 2 cm, and behind a sheet");
  return scene;
}

GlbScene makeCrossing(int) {
  GlbScene scene("boxes that cross");
  const auto white = plain(scene, "white", kWhite), red = plain(scene, "red", {0.6f, 0.2f, 0.15f}),
             blue = plain(scene, "blue", {0.2f, 0.3f, 0.6f}), grey = plain(scene, "grey", Vec3(0.5f));
  scene.place("shell", scene.addMesh("shell", shell(white, {-2, 0, -2}, {2, 2.5, 2})));
  placeBox(scene, "sunk", red, {-0.5, -0.3, -0.4}, {0.5, 0.6, 0.4}, translate({-0.6, 0, 0}) * rotateY(0.4));
  placeBox(scene, "tilted", blue, {-0.3, -0.6, -0.3}, {0.3, 0.8, 0.3},
           translate({0.05, 0.35, 0.1}) * rotate(0.6, glm::normalize(P3(0.3, 0.2, 1))));
  placeBox(scene, "leaning", grey, {-0.05, -0.8, -0.5}, {0.05, 0.8, 0.5},
           translate({0.95, 0.5, -0.3}) * rotateY(0.7) * rotate(0.5, {0, 0, 1}));
  placePanel(scene, lamp(scene, 20.0f), {0.3, 2.48, 0.6}, 0.3);
  scene.addCamera("boxes", {0.6, 1.5, 1.9}, {0.0, 0.3, 0.0}, 55);
  scene.addCamera("foot", {-0.5, 0.9, 1.5}, {-0.3, 0.05, 0.3}, 50);
  scene.note("boxes sunk into the floor and into each other");
  return scene;
}

GlbScene makeLampshade(int) {
  GlbScene scene("lamps in their shades");
  const auto white = plain(scene, "white", kWhite), wood = plain(scene, "wood", {0.45f, 0.3f, 0.18f}),
             metal = plain(scene, "metal", Vec3(0.4f)), cloth = plain(scene, "cloth", {0.7f, 0.65f, 0.5f}),
             sheet = plain(scene, "sheet", {0.7f, 0.65f, 0.5f}, true), light = lamp(scene, 200.0f);
  scene.place("shell", scene.addMesh("shell", shell(white, {-1.5, 0, -1.2}, {1.5, 2.4, 1.2})));
  MeshBuilder desk;
  desk.material(wood);
  table(desk, {0, 0, -0.6}, 1.6, 0.7, 0.72);
  scene.place("table", scene.addMesh("table", desk));
  placeTableLamp(scene, "walled lamp", metal, light, cloth, {-0.4, 0.72, -0.6}, true);
  placeTableLamp(scene, "sheet lamp", metal, light, sheet, {0.4, 0.72, -0.6}, false);
  scene.addCamera("table", {0.1, 1.45, 1.1}, {0, 0.95, -0.7}, 60);
  scene.addCamera("from below", {-0.2, 0.75, 0.2}, {-0.35, 0.95, -0.65}, 60);
  scene.note("bulbs in shades of two walls and of one sheet");
  return scene;
}

GlbScene makeFurniture(int) {
  GlbScene scene("furniture on a floor");
  const auto white = plain(scene, "white", kWhite), wood = plain(scene, "wood", {0.5f, 0.35f, 0.22f}),
             pale = plain(scene, "pale", {0.7f, 0.6f, 0.45f});
  scene.place("shell", scene.addMesh("shell", shell(white, {-2, 0, -1.5}, {2, 2.5, 1.5})));
  const auto cupboard = [&](const char* name, double x, double bottom) {
    placeBox(scene, name, wood, {x - 0.35, bottom, -1.1}, {x + 0.35, 1.1 + bottom, -0.7});
  };
  cupboard("standing", -1.2, 0.0), cupboard("hovering", -0.3, 0.001), cupboard("sunk", 0.6, -0.01);
  MeshBuilder desk;
  desk.material(pale);
  table(desk, {0.2, 0, 0.4}, 1.2, 0.7, 0.72);
  scene.place("table", scene.addMesh("table", desk));
  placePanel(scene, lamp(scene, 20.0f), {-0.2, 2.48, 0.5}, 0.3);
  scene.addCamera("cupboards", {-1.0, 1.5, 1.4}, {-0.2, 0.2, -0.6}, 60);
  scene.addCamera("feet", {-0.7, 0.7, 0.5}, {-0.55, 0.05, -0.7}, 50);
  scene.note("cupboards on, 1 mm over and 1 cm in the floor, and a table");
  return scene;
}

}  // namespace relume::scenes
