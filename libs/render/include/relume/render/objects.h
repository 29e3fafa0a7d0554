// SPDX-License-Identifier: MIT
// What moves through a baked world, as a renderer is told of it.
#pragma once
#include <cstdint>
#include <vector>

#include "relume/core/vec.h"

namespace relume::render {

/// Instances that move together. They share one cube map of the world about them.
struct Object {
  std::vector<std::uint32_t> instances;  ///< dynamic ones
  /// How it hides light from what is about it, where it stands when it is added (world); side 0: not at all.
  /// shape: [z][y][x]; xyz: mean hidden direction, w: hidden share of all directions.
  struct Occlusion {
    Box3 box;
    int side = 0;
    std::vector<Vec4> cells;
  } occlusion;
};

/// Where indirect light on objects comes from.
enum class ObjectLight : std::uint8_t {
  kNone,    ///< ambient light alone
  kCube,    ///< a cube map about each, read as if from where each place is (Szirmay-Kalos et al. 2005, 2006)
  kProbes,  ///< the probes of a layer `lightpath:exits=probes`, as spherical harmonics at the corners of its
            ///< box
};

}  // namespace relume::render
