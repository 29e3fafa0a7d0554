// SPDX-License-Identifier: MIT
// Directional light maps as a layer of kind `directional` keeps them (docs/format.md): for each direction of
// a set that all surfaces share one texture, in which every chart that faces it has a rectangle. Based on:
//   [HP02] Hey, Purgathofer. Real-Time Rendering of Globally Illuminated Soft Glossy Scenes With Directional
//   Light Maps. 2002. Section 3.1: packed by direction, resolution by projected area, 8 bit below a maximum.
// What differs: each rectangle has its own maximum, and bytes are the square root of the share of it.
#pragma once
#include <cstddef>
#include <cstdint>
#include <vector>

#include "relume/asset/asset.h"

namespace relume::asset {

struct DirectionMaps {
  /// Texels of the atlas that a chart lies in: [x, x + width) x [y, y + height) of a page.
  struct Chart {
    std::uint32_t page = 0, x = 0, y = 0, width = 0, height = 0;
  };
  /// Of a chart in a direction's texture; width 0: it does not face the direction. Around it lies a rim of
  /// one texel, its border repeated, so that bilinear look-ups stay with the chart.
  struct Rectangle {
    std::uint32_t x = 0, y = 0, width = 0, height = 0;
    float most = 0;  ///< irradiance on a plane perpendicular to the direction that a byte of 255 stands for
  };
  struct Texture {
    std::uint32_t width = 0, height = 0;
    std::vector<std::uint8_t> rgb;  ///< shape [height][width][3]; row 0 is the top one
  };

  std::vector<Direction> directions;  ///< world, unit, from the surface to the light
  std::vector<Chart> charts;          ///< by chart number of AtlasTable
  std::vector<Rectangle> rectangles;  ///< shape [charts][directions]
  std::vector<Texture> textures;      ///< by direction

  const Rectangle& at(std::size_t chart, std::size_t direction) const {
    return rectangles[chart * directions.size() + direction];
  }
};

std::vector<Table> tablesOf(const DirectionMaps& maps);

/// Throws Error kCorruptAsset for tables that are missing, of the wrong shape, or lead outside.
DirectionMaps directionMapsOf(const Layer& layer, const AtlasTable& atlas);

}  // namespace relume::asset
