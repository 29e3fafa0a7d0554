// SPDX-License-Identifier: MIT
// The scenes that Relume ships, made by code.
#pragma once
#include <span>
#include <string>

#include "glb_scene.h"

namespace relume::scenes {

inline constexpr int kDefaultDetail = 2;
inline constexpr int kLargestDetail = 16;

/// The Cornell box with the published coordinates and colours, 1 unit = 1 cm.
GlbScene makeCornell(int detail);
/// A castle hall of three rib-vaulted naves.
GlbScene makeHall(int detail);
/// A hall with windows and lamp posts (docs/day.md).
GlbScene makeDayHall(int detail);
/// Two halls and a doorway between them.
GlbScene makeHalls(int detail);
/// A Doric temple.
GlbScene makeTemple(int detail);
/// A small automobile on a turntable.
GlbScene makeCar(int detail);
/// A lit room between two dark ones (docs/leaks.md shows this scene and the next three).
GlbScene makeRooms(int detail);
/// Boxes sunk into the floor and into each other.
GlbScene makeCrossing(int detail);
/// Lamps inside their shades.
GlbScene makeLampshade(int detail);
/// Cupboards on, over and in the floor, and a table.
GlbScene makeFurniture(int detail);
/// A room lit by its ceiling and back wall, with soft gloss (docs/bases.md).
GlbScene makeGlossyRoom(int detail);

/// A corner of brick and cobbles whose relief is in height maps (docs/rendering.md).
GlbScene makeCourtyard(int detail);

/// A vase with a metal ball, to be put into other scenes.
GlbScene makeVase(int detail);

struct SceneEntry {
  const char* name;
  GlbScene (*make)(int detail);
};
std::span<const SceneEntry> allScenes();

}  // namespace relume::scenes
