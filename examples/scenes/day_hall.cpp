// SPDX-License-Identifier: MIT
// A castle hall for a summer day (docs/day.md), after the one of Koldinghus: tall windows in its long walls,
// which look east and west, none in its short ones, and a row of lamp posts that a timetable lights at dusk.
// Plan: x to the east, -z to the north; y = 0 is the floor.
#include "scenes.h"
#include "shapes.h"

namespace relume::scenes {
namespace {

constexpr double kHalfWidth = 4.5, kHalfLength = 9.0, kHeight = 6.4, kThickness = 0.7;
constexpr int kBays = 5;
constexpr double kBay = 2 * kHalfLength / kBays, kWindow = 1.5, kSill = 1.3, kLintel = 5.0;
constexpr double kPostX = 1.9, kPostHeight = 2.5;
constexpr int kPosts = 5;

struct Palette {
  std::uint32_t plaster, stone, dark_stone, wood, iron, red, green, grass, roof, flame;
};

double bayZ(int bay) { return -kHalfLength + (bay + 0.5) * kBay; }

/// A long wall whose inner face is at x = kHalfWidth, with a window in each bay.
MeshBuilder longWall(const Palette& p) {
  MeshBuilder m;
  m.material(p.plaster);
  const double in = kHalfWidth, out = kHalfWidth + kThickness, half = kWindow / 2;
  box(m, {in, -0.3, -kHalfLength - kThickness}, {out, kSill, kHalfLength + kThickness}, 0, kYLo | kYHi);
  box(m, {in, kLintel, -kHalfLength - kThickness}, {out, kHeight + 0.3, kHalfLength + kThickness}, 0, kYLo);
  double from = -kHalfLength - kThickness;
  for (int bay = 0; bay <= kBays; ++bay) {
    const double to = bay == kBays ? kHalfLength + kThickness : bayZ(bay) - half;
    box(m, {in, kSill, from}, {out, kLintel, to}, 0, kYLo | kYHi);
    if (bay < kBays) from = bayZ(bay) + half;
  }
  for (int bay = 0; bay < kBays; ++bay) {
    const double z = bayZ(bay);
    // What the bands above and below leave open in the window, and its stone frame.
    m.material(p.plaster);
    m.quad({in, kLintel, z - half}, {out, kLintel, z - half}, {out, kLintel, z + half},
           {in, kLintel, z + half});
    m.material(p.stone);
    box(m, {in - 0.12, kSill - 0.06, z - half - 0.15}, {out + 0.1, kSill + 0.06, z + half + 0.15}, 0.02);
    const double middle = 0.5 * (in + out);
    box(m, {middle - 0.07, kSill + 0.06, z - 0.07}, {middle + 0.07, kLintel, z + 0.07}, 0.02, kYLo | kYHi);
    box(m, {middle - 0.06, 3.4, z - half}, {middle + 0.06, 3.52, z + half}, 0.015, kZLo | kZHi);
  }
  return m;
}

/// The wall at the north end, inner face at z = -kHalfLength.
MeshBuilder endWall(const Palette& p) {
  MeshBuilder m;
  m.material(p.plaster);
  box(m, {-kHalfWidth, -0.3, -kHalfLength - kThickness}, {kHalfWidth, kHeight + 0.3, -kHalfLength}, 0,
      kYLo | kXLo | kXHi);
  return m;
}

MeshBuilder floorAndRoof(const Palette& p) {
  MeshBuilder m;
  // Flagstones in two shades; the top of one large slab would be a single chart, which is what is wanted.
  constexpr int kAcross = 6, kAlong = 12;
  for (int i = 0; i < kAcross; ++i)
    for (int j = 0; j < kAlong; ++j) {
      m.material((i + j) % 2 == 0 ? p.stone : p.dark_stone);
      const double x0 = -kHalfWidth + 2 * kHalfWidth * i / kAcross,
                   x1 = -kHalfWidth + 2 * kHalfWidth * (i + 1) / kAcross,
                   z0 = -kHalfLength + 2 * kHalfLength * j / kAlong,
                   z1 = -kHalfLength + 2 * kHalfLength * (j + 1) / kAlong;
      m.quad({x0, 0, z0}, {x0, 0, z1}, {x1, 0, z1}, {x1, 0, z0});
    }
  m.material(p.wood);
  m.quad({-kHalfWidth, kHeight, -kHalfLength}, {kHalfWidth, kHeight, -kHalfLength},
         {kHalfWidth, kHeight, kHalfLength}, {-kHalfWidth, kHeight, kHalfLength});
  for (int bay = 1; bay < kBays; ++bay) {
    const double z = -kHalfLength + bay * kBay;
    box(m, {-kHalfWidth, kHeight - 0.4, z - 0.18}, {kHalfWidth, kHeight, z + 0.18}, 0, kYHi | kXLo | kXHi);
  }
  m.material(p.roof);
  const double w = kHalfWidth + kThickness + 0.3, l = kHalfLength + kThickness + 0.3;
  box(m, {-w, kHeight + 0.3, -l}, {w, kHeight + 0.5, l});
  return m;
}

MeshBuilder ground(const Palette& p) {
  MeshBuilder m;
  m.material(p.grass);
  constexpr double kFar = 12;
  m.quad({-kFar, -0.3, -kFar}, {-kFar, -0.3, kFar}, {kFar, -0.3, kFar}, {kFar, -0.3, -kFar});
  return m;
}

/// A post with an open lantern: four bars and a cap about the flame.
MeshBuilder post(const Palette& p, int detail) {
  MeshBuilder m;
  const int segments = 4 + 2 * detail;
  m.material(p.iron);
  lathe(m,
        {{0.2, 0},
         {0.2, 0.08},
         {0.07, 0.16},
         {0.045, 0.5},
         {0.04, kPostHeight},
         {0.16, kPostHeight + 0.06},
         {0.0, kPostHeight + 0.07}},
        segments);
  for (const double x : {-0.13, 0.13})
    for (const double z : {-0.13, 0.13})
      box(m, {x - 0.012, kPostHeight + 0.06, z - 0.012}, {x + 0.012, kPostHeight + 0.42, z + 0.012}, 0,
          kYLo | kYHi);
  lathe(m, {{0.0, kPostHeight + 0.42}, {0.21, kPostHeight + 0.42}, {0.0, kPostHeight + 0.62}}, segments);
  m.material(p.flame);
  box(m, {-0.035, kPostHeight + 0.08, -0.035}, {0.035, kPostHeight + 0.2, 0.035}, 0.01, kYLo);
  return m;
}

MeshBuilder furniture(const Palette& p) {
  MeshBuilder m;
  m.material(p.red);
  box(m, {-1.0, 0, -kHalfLength + 1.2}, {1.0, 0.02, kHalfLength - 1.2}, 0, kYLo);
  // Hangings between the windows of the west wall, and at the north end.
  for (int bay = 1; bay < kBays; ++bay) {
    m.material(bay % 2 == 0 ? p.red : p.green);
    const double z = -kHalfLength + bay * kBay;
    box(m, {-kHalfWidth + 0.03, 1.6, z - 0.55}, {-kHalfWidth + 0.06, 4.6, z + 0.55});
  }
  m.material(p.green);
  box(m, {-1.6, 1.2, -kHalfLength + 0.03}, {1.6, 4.8, -kHalfLength + 0.06});
  // A table with benches along the west side.
  m.material(p.wood);
  const double x0 = -3.4, x1 = -2.5, z0 = -3.6, z1 = 3.6;
  box(m, {x0, 0.74, z0}, {x1, 0.82, z1}, 0.015);
  for (const double z : {z0 + 0.5, -0.1, z1 - 0.7})
    box(m, {x0 + 0.12, 0, z}, {x1 - 0.12, 0.74, z + 0.2}, 0.01, kYLo | kYHi);
  for (const double x : {x0 - 0.5, x1 + 0.15}) {
    box(m, {x, 0.4, z0}, {x + 0.35, 0.46, z1}, 0.01);
    for (const double z : {z0 + 0.5, -0.05, z1 - 0.6})
      box(m, {x + 0.05, 0, z}, {x + 0.3, 0.4, z + 0.1}, 0, kYLo | kYHi);
  }
  return m;
}

}  // namespace

GlbScene makeDayHall(int detail) {
  GlbScene scene("a castle hall for a summer day");
  const auto plain = [&](const char* name, Vec3 colour) {
    return scene.addMaterial({.name = name, .base_colour = colour});
  };
  const Palette p{.plaster = plain("lime plaster", {0.72f, 0.69f, 0.62f}),
                  .stone = plain("flagstone", {0.5f, 0.47f, 0.42f}),
                  .dark_stone = plain("dark flagstone", {0.36f, 0.34f, 0.31f}),
                  .wood = plain("oak", {0.33f, 0.22f, 0.13f}),
                  .iron = plain("wrought iron", {0.08f, 0.08f, 0.085f}),
                  .red = plain("crimson cloth", {0.55f, 0.05f, 0.05f}),
                  .green = plain("green cloth", {0.08f, 0.36f, 0.14f}),
                  .grass = plain("grass", {0.18f, 0.27f, 0.09f}),
                  .roof = plain("slate", {0.16f, 0.18f, 0.22f}),
                  .flame = scene.addMaterial(
                      {.name = "lamp posts", .base_colour = Vec3(0.8f), .emission = {40.0f, 23.0f, 9.0f}})};
  const auto mirrored = [](const MeshBuilder& m, P3 by) {
    MeshBuilder out;
    out.append(m, scale(by));
    return out;
  };
  scene.place("east wall", scene.addMesh("east wall", longWall(p)));
  scene.place("west wall", scene.addMesh("west wall", mirrored(longWall(p), {-1, 1, 1})));
  scene.place("north wall", scene.addMesh("north wall", endWall(p)));
  scene.place("south wall", scene.addMesh("south wall", mirrored(endWall(p), {1, 1, -1})));
  scene.place("floor and roof", scene.addMesh("floor and roof", floorAndRoof(p)));
  scene.place("ground", scene.addMesh("ground", ground(p)));
  scene.place("furniture", scene.addMesh("furniture", furniture(p)));
  const auto lamp = scene.addLight({.name = "lamp post",
                                    .type = "point",
                                    .colour = {1.0f, 0.72f, 0.42f},
                                    .intensity = 4,
                                    .group = "lamp posts"});
  const auto lantern = scene.addMesh("lamp post", post(p, detail));
  for (int i = 0; i < kPosts; ++i) {
    const P3 foot(kPostX + 0.8, 0, bayZ(i) + kBay / 2 * (i + 1 < kPosts ? 1 : 0.72));
    const std::string name = "lamp post " + std::to_string(i + 1);
    scene.place(name, lantern, {.position = foot});
    scene.placeLight(name, lamp, foot + P3(0, kPostHeight + 0.3, 0));
  }
  scene.addCamera("along the hall", {-1.6, 1.75, 8.3}, {0.9, 2.0, -2.5}, 62);
  scene.addCamera("the windows", {-3.9, 1.7, -6.5}, {3.5, 2.4, 2.5}, 62);
  scene.note("a castle hall with tall windows and a row of lamp posts");
  return scene;
}

}  // namespace relume::scenes
