// SPDX-License-Identifier: MIT
#include "relume/asset/direction_maps.h"

#include <gtest/gtest.h>

#include <functional>

#include "relume/core/error.h"

namespace relume::asset {
namespace {

AtlasTable atlasOf(std::uint32_t charts) {
  AtlasTable atlas;
  atlas.width = atlas.height = 8, atlas.pages = 1;
  for (std::uint32_t c = 0; c < charts; ++c) atlas.texel.push_back(c), atlas.chart.push_back(c);
  return atlas;
}

DirectionMaps example() {
  DirectionMaps maps;
  maps.directions = {{0, 1, 0}, {1, 0, 0}};
  maps.charts = {{0, 0, 0, 4, 4}, {0, 4, 0, 4, 8}};
  maps.rectangles = {{1, 1, 4, 4, 2.5f}, {}, {}, {1, 1, 2, 3, 1}};
  maps.textures = {{6, 6, std::vector<std::uint8_t>(108, 7)}, {4, 5, std::vector<std::uint8_t>(60, 9)}};
  return maps;
}

Layer layerOf(const DirectionMaps& maps) {
  Layer layer;
  layer.name = layer.kind = "directional";
  layer.tables = tablesOf(maps);
  return layer;
}

TEST(DirectionMaps, ComeBackFromTheirTables) {
  const DirectionMaps maps = example(), back = directionMapsOf(layerOf(maps), atlasOf(2));
  EXPECT_EQ(back.directions, maps.directions);
  ASSERT_EQ(back.rectangles.size(), 4u);
  EXPECT_EQ(back.at(0, 0).most, 2.5f);
  EXPECT_EQ(back.at(1, 1).height, 3u);
  EXPECT_EQ(back.at(1, 0).width, 0u);
  EXPECT_EQ(back.textures[1].rgb, maps.textures[1].rgb);
  EXPECT_EQ(back.charts[1].x, 4u);
}

TEST(DirectionMaps, WhatLeadsOutsideIsRefused) {
  const std::vector<std::function<void(DirectionMaps&)>> damages = {
      [](DirectionMaps& m) { m.rectangles[0].x = 3; },
      [](DirectionMaps& m) { m.rectangles[0].height = 0; },
      [](DirectionMaps& m) { m.rectangles[3].y = 0xffffffffu; },
      [](DirectionMaps& m) { m.rectangles[0].most = -1; },
      [](DirectionMaps& m) { m.rectangles.pop_back(); },
      [](DirectionMaps& m) { m.charts[1].height = 9; },
      [](DirectionMaps& m) { m.charts[0].page = 1; },
      [](DirectionMaps& m) {
        m.directions[1] = {2, 0, 0};
      },
      [](DirectionMaps& m) { m.textures[0].rgb.pop_back(); },
      [](DirectionMaps& m) { m.textures[1].width = 0xffffffffu; },
      [](DirectionMaps& m) { m.directions.clear(), m.rectangles.clear(); },
  };
  for (std::size_t i = 0; i < damages.size(); ++i) {
    DirectionMaps maps = example();
    damages[i](maps);
    Layer layer = layerOf(maps);
    try {
      directionMapsOf(layer, atlasOf(2));
      ADD_FAILURE() << i;
    } catch (const Error& e) {
      EXPECT_EQ(e.code(), ErrorCode::kCorruptAsset) << i;
    }
  }
  EXPECT_THROW(directionMapsOf(layerOf(example()), atlasOf(3)), Error);  // a chart that the maps do not know
  Layer bare;
  EXPECT_THROW(directionMapsOf(bare, atlasOf(2)), Error);
}

}  // namespace
}  // namespace relume::asset
