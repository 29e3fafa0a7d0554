// SPDX-License-Identifier: MIT
// Two halls and the doorway between them, after the scene of the light path map paper: one hung with red, one
// with green, so that one sees where the light of a lamp has been. Plan: x along both halls, z across; y = 0
// is the floor.
#include <algorithm>

#include "scenes.h"
#include "shapes.h"

namespace relume::scenes {
namespace {

constexpr double kLength = 10.0, kHalfWidth = 4.0, kHeight = 5.2;  // of one hall
constexpr double kWall = 0.35;                                     // half of the wall between
constexpr double kDoorHalf = 1.3, kDoorHeight = 3.4;
constexpr double kColumn = 0.28;  // half its side
constexpr int kColumns = 4;       // along a wall

struct Palette {
  std::uint32_t plaster, stone, wood, cloth, paint;
};

double columnX(int i) { return kWall + (kLength - kWall) * (i + 0.5) / kColumns; }

/// The half at +x, but for the wall between.
MeshBuilder shell(const Palette& p, double to) {
  MeshBuilder m;
  const double w = kHalfWidth, h = kHeight, dado = 1.1;
  m.material(p.stone);
  m.quad({0, 0, -w}, {0, 0, w}, {to, 0, w}, {to, 0, -w});
  m.material(p.wood);
  m.quad({0, h, -w}, {to, h, -w}, {to, h, w}, {0, h, w});
  const auto walls = [&](double lo, double hi) {
    m.quad({kWall, lo, -w}, {to, lo, -w}, {to, hi, -w}, {kWall, hi, -w});
    m.quad({kWall, lo, w}, {kWall, hi, w}, {to, hi, w}, {to, lo, w});
    m.quad({to, lo, -w}, {to, lo, w}, {to, hi, w}, {to, hi, -w});
  };
  m.material(p.paint);
  walls(0, dado);
  m.material(p.plaster);
  walls(dado, h);
  return m;
}

MeshBuilder furniture(const Palette& p) {
  MeshBuilder m;
  m.material(p.stone);
  for (int i = 0; i < kColumns; ++i)
    for (const double side : {-1.0, 1.0}) {
      const P3 foot(columnX(i), 0, side * (kHalfWidth - 0.9));
      box(m, foot - P3(kColumn + 0.1, 0, kColumn + 0.1), foot + P3(kColumn + 0.1, 0.3, kColumn + 0.1), 0.04,
          kYLo);
      box(m, foot + P3(-kColumn, 0.3, -kColumn), foot + P3(kColumn, kHeight - 0.35, kColumn), 0.05,
          kYLo | kYHi);
    }
  m.material(p.wood);
  for (int i = 0; i < kColumns; ++i)
    box(m, {columnX(i) - 0.22, kHeight - 0.35, -kHalfWidth}, {columnX(i) + 0.22, kHeight, kHalfWidth}, 0.0,
        kYHi | kZLo | kZHi);
  // A long table with two benches.
  const double x0 = 4.2, x1 = 7.4;
  box(m, {x0, 0.74, -1.85}, {x1, 0.82, -0.95}, 0.015);
  for (const double x : {x0 + 0.3, x1 - 0.45})
    box(m, {x, 0, -1.7}, {x + 0.15, 0.74, -1.1}, 0.01, kYLo | kYHi);
  for (const double z : {-2.35, -0.75}) {
    box(m, {x0, 0.4, z}, {x1, 0.46, z + 0.3}, 0.01);
    for (const double x : {x0 + 0.3, x1 - 0.4})
      box(m, {x, 0, z + 0.05}, {x + 0.1, 0.4, z + 0.25}, 0.0, kYLo | kYHi);
  }
  // A carpet and hangings.
  m.material(p.cloth);
  box(m, {1.2, 0, 0.1}, {kLength - 1.2, 0.02, 1.9}, 0.0, kYLo);
  for (int i = 0; i + 1 < kColumns; ++i)
    for (const double side : {-1.0, 1.0}) {
      const double x = 0.5 * (columnX(i) + columnX(i + 1)), near = side * (kHalfWidth - 0.06),
                   far = side * (kHalfWidth - 0.03);
      box(m, {x - 0.75, 1.4, std::min(near, far)}, {x + 0.75, 4.4, std::max(near, far)});
    }
  return m;
}

/// Fills what the doorway leaves, and its jambs.
MeshBuilder between(const Palette& p) {
  MeshBuilder m;
  m.material(p.plaster);
  box(m, {-kWall, 0, -kHalfWidth}, {kWall, kHeight, -kDoorHalf}, 0.0, kYLo | kYHi | kZLo);
  box(m, {-kWall, 0, kDoorHalf}, {kWall, kHeight, kHalfWidth}, 0.0, kYLo | kYHi | kZHi);
  box(m, {-kWall, kDoorHeight, -kDoorHalf}, {kWall, kHeight, kDoorHalf}, 0.0, kYHi | kZLo | kZHi);
  return m;
}

}  // namespace

GlbScene makeHalls(int) {
  GlbScene scene("two halls");
  const auto plain = [&](const char* name, Vec3 colour) {
    return scene.addMaterial({.name = name, .base_colour = colour});
  };
  const auto plaster = plain("plaster", {0.74f, 0.72f, 0.67f}), stone = plain("stone", {0.5f, 0.48f, 0.45f}),
             wood = plain("wood", {0.34f, 0.24f, 0.15f});
  const Palette red{plaster, stone, wood, plain("red cloth", {0.62f, 0.05f, 0.04f}),
                    plain("red paint", {0.55f, 0.16f, 0.1f})},
      green{plaster, stone, wood, plain("green cloth", {0.05f, 0.42f, 0.14f}),
            plain("green paint", {0.14f, 0.42f, 0.3f})};
  const auto mirrored = [](const MeshBuilder& m) {
    MeshBuilder out;
    out.append(m, scale({-1, 1, 1}));
    return out;
  };
  scene.place("red hall", scene.addMesh("red hall", mirrored(shell(red, kLength))));
  scene.place("green hall", scene.addMesh("green hall", shell(green, kLength)));
  scene.place("wall between", scene.addMesh("wall between", between(red)));
  scene.place("red furniture", scene.addMesh("red furniture", mirrored(furniture(red))));
  scene.place("green furniture", scene.addMesh("green furniture", furniture(green)));
  const auto lamp = scene.addLight(
      {.name = "lamp", .type = "point", .colour = {1.0f, 0.86f, 0.68f}, .intensity = 45, .group = "lamp"});
  scene.placeLight("lamp", lamp, {-5.5, 2.2, 0.6});
  scene.addCamera("through the doorway", {-9.5, 2.3, 1.5}, {0.0, 1.7, -0.3}, 55);
  scene.addCamera("green hall", {9.5, 2.3, 1.5}, {0.0, 1.7, -0.3}, 55);
  scene.note("two halls, hung with red and with green, and a doorway between them");
  return scene;
}

}  // namespace relume::scenes
