// SPDX-License-Identifier: MIT
// Textures for ordinary viewers, decoded again.
#include "relume/bake/viewer_textures.h"

#include <gtest/gtest.h>

#include "relume/image/io.h"

namespace relume::bake {
namespace {

constexpr int kSize = 16;

asset::Layer layerOf(const char* kind, int channels, std::vector<float> values) {
  asset::Layer layer{.name = kind, .kind = kind};
  layer.planes.push_back({.name = "value", .channels = channels, .values = std::move(values)});
  return layer;
}

/// Pages of kSize x kSize texels, all covered.
asset::AtlasTable atlasOf(std::uint32_t pages) {
  asset::AtlasTable atlas{.width = kSize, .height = kSize, .pages = pages};
  for (std::uint32_t i = 0; i < pages * kSize * kSize; ++i) atlas.texel.push_back(i);
  return atlas;
}

std::vector<float> filled(std::uint32_t pages, Vec3 value) {
  std::vector<float> values;
  for (std::uint32_t i = 0; i < pages * kSize * kSize; ++i)
    values.insert(values.end(), {value.x, value.y, value.z});
  return values;
}

TEST(LightmapPages, EachPageHasTheIntensityOfItsBrightestTexel) {
  std::vector<float> values = filled(2, {1, 0.5f, 0.25f});
  for (std::size_t i = values.size() / 2; i < values.size(); ++i) values[i] *= 5000;
  const auto pages = lightmapPages(atlasOf(2), layerOf("lightmap", 3, values));
  ASSERT_EQ(pages.size(), 2u);
  EXPECT_FLOAT_EQ(pages[0].intensity, 1);
  EXPECT_FLOAT_EQ(pages[1].intensity, 5000);
  for (const auto& page : pages) {
    const image::Image8 texels = image::decodeTexture(page.png, "page");
    ASSERT_EQ(texels.channels, 3);
    for (std::size_t i = 0; i < texels.data.size(); i += 3) {
      EXPECT_EQ(texels.data[i], 255) << "the brightest value is exact";
      EXPECT_NEAR(texels.data[i + 1], 127.5, 1);
      EXPECT_NEAR(texels.data[i + 2], 63.75, 1);
    }
  }
}

TEST(LightmapPages, DitheringKeepsTheMean) {
  std::vector<float> values = filled(1, Vec3(0.3f / 255));  // a third of the smallest step
  values[0] = values[1] = values[2] = 1;
  const auto pages = lightmapPages(atlasOf(1), layerOf("lightmap", 3, values));
  const image::Image8 texels = image::decodeTexture(pages[0].png, "page");
  double sum = 0;
  for (std::size_t i = 3; i < texels.data.size(); i += 3) {
    EXPECT_LE(texels.data[i], 1);
    EXPECT_EQ(texels.data[i], texels.data[i + 2]) << "grey has become coloured";
    sum += texels.data[i];
  }
  EXPECT_NEAR(sum / (kSize * kSize - 1), 0.3, 0.02);
}

TEST(LightmapPages, BlackStaysBlackAndNothingIsCovered) {
  const auto black = lightmapPages(atlasOf(1), layerOf("lightmap", 3, filled(1, Vec3(0))));
  EXPECT_EQ(black[0].intensity, 1);
  for (const unsigned char v : image::decodeTexture(black[0].png, "page").data) EXPECT_EQ(v, 0);
  asset::AtlasTable nothing = atlasOf(1);
  nothing.texel.clear();
  EXPECT_EQ(lightmapPages(nothing, layerOf("lightmap", 3, filled(1, Vec3(7))))[0].intensity, 1);
}

TEST(LightmapPages, WhatNoSurfaceCoversDoesNotSetTheScale) {
  asset::AtlasTable atlas = atlasOf(1);
  atlas.texel.erase(atlas.texel.begin());
  std::vector<float> values = filled(1, Vec3(2));
  values[0] = 900;
  EXPECT_EQ(lightmapPages(atlas, layerOf("lightmap", 3, values))[0].intensity, 2);
}

TEST(LightmapPages, AnOutlierDoesNotTakeTheSteps) {
  constexpr std::uint32_t kTexels = 512 * 256;  // two outliers may be clipped
  asset::AtlasTable atlas{.width = 512, .height = 256, .pages = 1};
  for (std::uint32_t i = 0; i < kTexels; ++i) atlas.texel.push_back(i);
  std::vector<float> values(std::size_t{kTexels} * 3, 1.0f);
  values[300] = 1e6f, values[3000] = 1e5f;
  EXPECT_EQ(lightmapPages(atlas, layerOf("lightmap", 3, values))[0].intensity, 4);
  values[30000] = 50;  // three are no outliers
  EXPECT_EQ(lightmapPages(atlas, layerOf("lightmap", 3, values))[0].intensity, 200);
}

TEST(ViewerTextures, IrradianceIsNotOccludedTwice) {
  asset::Asset asset;
  asset.atlas = atlasOf(1);
  asset.layers.push_back(layerOf("ao", 1, std::vector<float>(kSize * kSize, 0.5f)));
  scene::gltf::BakeOutput occlusion;
  addViewerTextures(asset, occlusion);
  EXPECT_EQ(occlusion.occlusion_png.size(), 1u);
  EXPECT_TRUE(occlusion.lightmap.empty());
  asset.layers.push_back(layerOf("lightmap", 3, filled(1, Vec3(3))));
  scene::gltf::BakeOutput both;
  addViewerTextures(asset, both);
  EXPECT_TRUE(both.occlusion_png.empty());
  EXPECT_EQ(both.lightmap.size(), 1u);
}

}  // namespace
}  // namespace relume::bake
