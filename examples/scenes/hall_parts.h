// SPDX-License-Identifier: MIT
// The castle hall's parts. Plan: x across, z along; three naves, the middle one between the column lines x =
// +-kColumnX; the dais at -z, the portal at +z. Floor y = 0.
#pragma once
#include <cstdint>
#include <optional>

#include "shapes.h"

namespace relume::scenes::hall {

inline constexpr int kBays = 5;
inline constexpr double kBay = 4.2, kNave = 5.4, kAisle = 3.8;
inline constexpr double kColumnX = kNave / 2, kWallX = kColumnX + kAisle, kWallZ = kBays * kBay / 2;
inline constexpr double kThickness = 0.9;  // of the outer walls
inline constexpr double kSpringing = 4.6, kRise = 3.1, kCrown = kSpringing + kRise;
inline constexpr double kEaves = 8.6, kOutside = -0.6;  // wall top; ground level outside
inline constexpr double kDaisX = 2.3, kDaisZ = -6.6, kDaisHeight = 0.48;

struct Palette {
  std::uint32_t stone, rib, plaster, rough, slate, wood, iron, wax, flame, red, blue, green, gold, floor,
      grass;
};

/// A groin vault over [-span/2, span/2] x [-kBay/2, kBay/2] with diagonal ribs and a boss. y = 0 is the
/// springing.
MeshBuilder vault(const Palette& p, double span, int detail);
/// A pointed arch rib across `span` in the plane z = 0; `half`: only its side towards +z, for walls. y = 0 is
/// the springing.
MeshBuilder archRib(const Palette& p, double span, double width, double depth, bool half, int detail);
MeshBuilder pier(const Palette& p, int detail);
/// A wall shaft with base and capital, `turn` of its round (pi: against a wall, beginning at +X towards +Z).
MeshBuilder respond(const Palette& p, double turn, int detail);

struct Opening {
  double width, sill, springing, rise;
  bool door = false;
  int mullions = 1;
};
/// A wall of one bay with its inner face in z = 0, looking to +z, and its outer face in z = -kThickness.
MeshBuilder wall(const Palette& p, double span, const std::optional<Opening>& opening, int detail);
MeshBuilder buttress(const Palette& p);
MeshBuilder battlement(const Palette& p, double span);
/// Three quarters of a round tower about the outer corner +x, +z, a whole drum above the eaves.
MeshBuilder tower(const Palette& p, int detail);
MeshBuilder roof(const Palette& p);
MeshBuilder floor(const Palette& p);
MeshBuilder dais(const Palette& p);
MeshBuilder ground(const Palette& p);
MeshBuilder frontSteps(const Palette& p);

MeshBuilder throne(const Palette& p, int detail);
/// Cloth hanging from y = 0 down to -height in the plane z = 0; a swallowtail when `tails`.
MeshBuilder banner(std::uint32_t cloth, std::uint32_t border, double width, double height, bool tails,
                   double wave, int detail);
MeshBuilder bannerPole(const Palette& p);
MeshBuilder candelabrum(const Palette& p, int detail);
/// Hangs from y = 0.
MeshBuilder chandelier(const Palette& p, double drop, int detail);
MeshBuilder table(const Palette& p, double length, int detail);
MeshBuilder chest(const Palette& p, int detail);

}  // namespace relume::scenes::hall
