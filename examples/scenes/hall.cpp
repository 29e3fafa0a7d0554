// SPDX-License-Identifier: MIT
// A castle hall: three naves of five rib-vaulted bays, tall windows with tracery, a dais with a throne,
// candelabra, swinging chandeliers.
#include <cmath>
#include <string>

#include "hall_parts.h"
#include "picture.h"
#include "scenes.h"

namespace relume::scenes {
namespace {

using namespace hall;

Palette makePalette(GlbScene& scene) {
  const auto plain = [&](const char* name, Vec3 colour, float roughness = 0.9f) {
    return scene.addMaterial({.name = name, .base_colour = colour, .roughness = roughness});
  };
  Palette p{};
  p.stone = plain("dressed stone", {0.58f, 0.54f, 0.46f}, 0.8f);
  p.rib = plain("vault ribs", {0.52f, 0.46f, 0.37f});
  p.plaster = plain("lime plaster", {0.74f, 0.71f, 0.64f});
  p.rough = plain("field stone", {0.4f, 0.38f, 0.34f}, 1.0f);
  p.slate = plain("slate", {0.16f, 0.18f, 0.22f}, 0.7f);
  p.wood = plain("oak", {0.26f, 0.15f, 0.08f}, 0.6f);
  p.iron = plain("wrought iron", {0.06f, 0.06f, 0.065f}, 0.5f);
  p.wax = plain("wax", {0.85f, 0.78f, 0.6f}, 0.5f);
  p.flame = scene.addMaterial({.name = "flame", .base_colour = Vec3(0.8f), .emission = {30.0f, 17.0f, 6.0f}});
  p.red = plain("crimson cloth", {0.5f, 0.035f, 0.04f}, 1.0f);
  p.blue = plain("blue cloth", {0.04f, 0.1f, 0.42f}, 1.0f);
  p.green = plain("green cloth", {0.05f, 0.27f, 0.09f}, 1.0f);
  p.gold = plain("gold", {0.72f, 0.5f, 0.14f}, 0.4f);
  p.grass = plain("grass", {0.18f, 0.27f, 0.09f}, 1.0f);
  const auto tiles = scene.addTexture("floor tiles", floorTiles());
  p.floor = scene.addMaterial(
      {.name = "floor tiles", .base_colour = Vec3(1.0f), .roughness = 0.35f, .texture = tiles});
  return p;
}

void buildShell(GlbScene& scene, const Palette& p, int detail) {
  const double y = kSpringing;
  const auto nave_vault = scene.addMesh("nave vault", vault(p, kNave, detail)),
             aisle_vault = scene.addMesh("aisle vault", vault(p, kAisle, detail));
  const auto across_nave = scene.addMesh("nave arch", archRib(p, kNave, 0.42, 0.32, false, detail));
  const auto across_aisle = scene.addMesh("aisle arch", archRib(p, kAisle, 0.42, 0.32, false, detail));
  const auto arcade = scene.addMesh("arcade arch", archRib(p, kBay, 0.52, 0.38, false, detail));
  const auto wall_nave = scene.addMesh("nave wall arch", archRib(p, kNave, 0.42, 0.2, true, detail));
  const auto wall_aisle = scene.addMesh("aisle wall arch", archRib(p, kAisle, 0.42, 0.2, true, detail));
  const auto wall_bay = scene.addMesh("bay wall arch", archRib(p, kBay, 0.42, 0.2, true, detail));
  const auto column = scene.addMesh("pier", pier(p, detail));
  const auto half = scene.addMesh("wall shaft", respond(p, kTau / 2, detail)),
             quarter = scene.addMesh("corner shaft", respond(p, kTau / 4, detail));
  const auto window = scene.addMesh("window bay", wall(p, kBay, Opening{1.7, 1.7, 4.4, 1.75}, detail));
  const auto aisle_end =
      scene.addMesh("aisle end", wall(p, kAisle, Opening{1.2, 2.2, 4.4, 1.3, false, 0}, detail));
  const auto nave_end =
      scene.addMesh("throne wall", wall(p, kNave, Opening{2.7, 4.1, 5.1, 1.95, false, 2}, detail));
  const auto portal = scene.addMesh("portal wall", wall(p, kNave, Opening{2.2, 0.0, 2.6, 1.7, true}, detail));
  const auto prop = scene.addMesh("buttress", buttress(p));
  const auto top_bay = scene.addMesh("battlement", battlement(p, kBays * kBay));
  const double aisle_x = (kColumnX + kWallX) / 2, out_x = kWallX + kThickness;
  const auto name = [](const char* what, int i, const char* side = "") {
    return std::string(what) + " " + std::to_string(i + 1) + side;
  };

  for (int b = 0; b < kBays; ++b) {
    const double z = -kWallZ + (b + 0.5) * kBay;
    scene.place(name("nave vault", b), nave_vault, {.position = {0, y, z}});
    for (const double s : {-1.0, 1.0}) {
      const char* side = s < 0 ? " west" : " east";
      scene.place(name("aisle vault", b, side), aisle_vault, {.position = {s * aisle_x, y, z}});
      scene.place(name("arcade", b, side), arcade, {.position = {s * kColumnX, y, z}, .turn_y = kTau / 4});
      scene.place(name("window", b, side), window, {.position = {s * kWallX, 0, z}, .turn_y = -s * kTau / 4});
      scene.place(name("wall arch", b, side), wall_bay,
                  {.position = {s * kWallX, y, z}, .turn_y = -s * kTau / 4});
    }
  }
  for (int b = 1; b < kBays; ++b) {
    const double z = -kWallZ + b * kBay;
    scene.place(name("nave arch", b), across_nave, {.position = {0, y, z}});
    for (const double s : {-1.0, 1.0}) {
      const char* side = s < 0 ? " west" : " east";
      scene.place(name("aisle arch", b, side), across_aisle, {.position = {s * aisle_x, y, z}});
      scene.place(name("pier", b, side), column, {.position = {s * kColumnX, 0, z}});
      // A half round beginning at +X bulges to +Z; turned so that it bulges into the room.
      scene.place(name("wall shaft", b, side), half,
                  {.position = {s * kWallX, 0, z}, .turn_y = -s * kTau / 4});
      scene.place(name("buttress", b, side), prop, {.position = {s * out_x, 0, z}, .turn_y = s * kTau / 4});
    }
  }
  for (const double e : {-1.0, 1.0}) {
    const std::string end = e < 0 ? " north" : " south";
    const double turn = e < 0 ? 0.0 : kTau / 2;
    scene.place(e < 0 ? "throne wall" : "portal wall", e < 0 ? nave_end : portal,
                {.position = {0, 0, e * kWallZ}, .turn_y = turn});
    scene.place("nave wall arch" + end, wall_nave, {.position = {0, y, e * kWallZ}, .turn_y = turn});
    for (const double s : {-1.0, 1.0}) {
      const std::string side = end + (s < 0 ? " west" : " east");
      scene.place("aisle end" + side, aisle_end, {.position = {s * aisle_x, 0, e * kWallZ}, .turn_y = turn});
      scene.place("aisle wall arch" + side, wall_aisle,
                  {.position = {s * aisle_x, y, e * kWallZ}, .turn_y = turn});
      scene.place("end shaft" + side, half, {.position = {s * kColumnX, 0, e * kWallZ}, .turn_y = turn});
      // The quarter round fills +X +Z; turned into the room's corner.
      const double corner = e < 0 ? (s < 0 ? 0.0 : -kTau / 4) : (s < 0 ? kTau / 4 : kTau / 2);
      scene.place("corner shaft" + side, quarter,
                  {.position = {s * kWallX, 0, e * kWallZ}, .turn_y = corner});
      scene.place("end buttress" + side, prop,
                  {.position = {s * kColumnX, 0, e * (kWallZ + kThickness)}, .turn_y = e < 0 ? kTau / 2 : 0});
    }
  }
  scene.place("battlement east", top_bay, {.position = {out_x, kEaves, 0}, .turn_y = kTau / 4});
  scene.place("battlement west", top_bay, {.position = {-out_x, kEaves, 0}, .turn_y = -kTau / 4});
  const auto round = scene.addMesh("corner tower", tower(p, detail));
  scene.place("tower south east", round);
  scene.place("tower south west", round, {.scale = {-1, 1, 1}});
  scene.place("tower north east", round, {.scale = {1, 1, -1}});
  scene.place("tower north west", round, {.scale = {-1, 1, -1}});
  scene.place("roof", scene.addMesh("roof", roof(p)));
  scene.place("floor", scene.addMesh("floor", floor(p)));
  scene.place("dais", scene.addMesh("dais", dais(p)));
  scene.place("ground", scene.addMesh("ground", ground(p)));
  scene.place("front steps", scene.addMesh("front steps", frontSteps(p)));
}

void furnish(GlbScene& scene, const Palette& p, int detail) {
  scene.place("throne", scene.addMesh("throne", throne(p, detail)),
              {.position = {0, kDaisHeight, -9.3}, .scale = P3(1.15)});
  // Banners on poles lean into the nave from the piers; tapestries hang on the end walls.
  const std::uint32_t cloth[] = {
      scene.addMesh("crimson banner", banner(p.red, p.gold, 0.7, 1.6, true, 0.07, detail)),
      scene.addMesh("blue banner", banner(p.blue, p.gold, 0.7, 1.6, true, 0.07, detail)),
      scene.addMesh("green banner", banner(p.green, p.gold, 0.7, 1.6, true, 0.07, detail))};
  const auto pole = scene.addMesh("banner pole", bannerPole(p));
  for (int b = 1; b < kBays; ++b)
    for (const double s : {-1.0, 1.0}) {
      const double z = -kWallZ + b * kBay;
      const std::string where = " " + std::to_string(b) + (s < 0 ? " west" : " east");
      scene.place("banner pole" + where, pole,
                  {.position = {s * (kColumnX - 0.36), 3.72, z}, .turn_y = -s * kTau / 4});
      scene.place("banner" + where, cloth[(b + (s > 0)) % 3],
                  {.position = {s * (kColumnX - 0.92), 3.69, z}, .turn_y = s > 0 ? 0.0 : kTau / 2});
    }
  const auto hanging = scene.addMesh("tapestry", banner(p.red, p.gold, 2.3, 3.0, false, 0.035, detail + 1));
  const auto narrow = scene.addMesh("narrow tapestry", banner(p.blue, p.gold, 0.85, 3.0, true, 0.03, detail));
  scene.place("tapestry", hanging, {.position = {0, 3.75, -kWallZ + 0.07}});
  for (const double s : {-1.0, 1.0})
    scene.place(s < 0 ? "tapestry west" : "tapestry east", narrow,
                {.position = {s * 1.72, 3.75, -kWallZ + 0.07}});

  const auto stand = scene.addMesh("candelabrum", candelabrum(p, detail));
  const Vec3 warm(1.0f, 0.66f, 0.34f);
  const auto east = scene.addLight({.name = "east candles",
                                    .type = "point",
                                    .colour = warm,
                                    .intensity = 4.0f,
                                    .group = "east candelabra"});
  const auto west = scene.addLight({.name = "west candles",
                                    .type = "point",
                                    .colour = warm,
                                    .intensity = 4.0f,
                                    .group = "west candelabra"});
  const auto high = scene.addLight(
      {.name = "throne candles", .type = "point", .colour = warm, .intensity = 5.0f, .group = "throne"});
  const auto ring = scene.addLight({.name = "chandelier candles",
                                    .type = "point",
                                    .colour = {1.0f, 0.72f, 0.42f},
                                    .intensity = 9.0f,
                                    .group = "chandeliers"});
  const auto sun = scene.addLight({.name = "sun",
                                   .type = "directional",
                                   .colour = {1.0f, 0.93f, 0.8f},
                                   .intensity = 14.0f,
                                   .group = "sun"});
  for (int b = 1; b < kBays; ++b)
    for (const double s : {-1.0, 1.0}) {
      const P3 at(s * kColumnX, 0, -kWallZ + (b + 0.5) * kBay);
      const std::string where = " " + std::to_string(b) + (s < 0 ? " west" : " east");
      scene.place("candelabrum" + where, stand, {.position = at});
      scene.placeLight("candles" + where, s < 0 ? west : east, at + P3(0, 2.05, 0));
    }
  for (const double s : {-1.0, 1.0}) {
    const P3 at(s * 1.15, kDaisHeight, -9.5);
    const std::string where = s < 0 ? " west" : " east";
    scene.place("throne candelabrum" + where, stand, {.position = at, .turn_y = s});
    scene.placeLight("throne candles" + where, high, at + P3(0, 2.05, 0));
  }
  const double drop = 3.2, pivot = kCrown - 0.34;
  const auto wheel = scene.addMesh("chandelier", chandelier(p, drop, detail));
  for (const int b : {1, 3}) {
    const double z = -kWallZ + (b + 0.5) * kBay;
    const std::string where = b == 1 ? " north" : " south";
    const auto node = scene.place("chandelier" + where, wheel, {.position = {0, pivot, z}});
    scene.swing(node, b == 1 ? 2.5 : -2.0, b == 1 ? 3.6 : 3.8);
    scene.placeLight("chandelier light" + where, ring, {0, pivot - drop + 0.45, z});
  }
  scene.placeLight("sun", sun, {26, 24, 9}, {0, 0, 0});

  const auto board = scene.addMesh("table", table(p, 5.4, detail));
  const auto box_mesh = scene.addMesh("chest", chest(p, detail));
  for (const double s : {-1.0, 1.0}) {
    const std::string where = s < 0 ? " west" : " east";
    scene.place("table" + where, board, {.position = {s * 4.6, 0, 1.2}, .turn_y = s > 0 ? 0.0 : kTau / 2});
    scene.place("chest" + where, box_mesh, {.position = {s * 4.6, 0, -kWallZ + 0.6}});
    scene.place("chest south" + where, box_mesh,
                {.position = {s * (kWallX - 0.5), 0, kWallZ - 2.1}, .turn_y = -s * kTau / 4});
  }
}

}  // namespace

GlbScene makeHall(int detail) {
  GlbScene scene("Castle hall");
  const Palette p = makePalette(scene);
  buildShell(scene, p, detail);
  furnish(scene, p, detail);
  scene.addCamera("portal", {0.3, 1.75, 9.7}, {-0.1, 2.9, -6}, 62);
  scene.addCamera("throne", {0.9, 2.1, -8.6}, {-0.6, 2.4, 6}, 60);
  scene.addCamera("aisle", {-5.3, 1.7, 9.7}, {-3.6, 2.8, -3}, 62);
  scene.addCamera("dais", {1.9, 1.6, -3.2}, {-0.3, 1.9, -10}, 55);
  scene.addCamera("vault", {0, 1.2, 4.5}, {0, 7.4, -2.2}, 70);
  scene.addCamera("outside", {24, 6, 30}, {0, 4.5, 0}, 40);
  scene.note("castle hall");
  return scene;
}

}  // namespace relume::scenes
