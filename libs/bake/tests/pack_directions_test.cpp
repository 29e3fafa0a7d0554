// SPDX-License-Identifier: MIT
#include "pack_directions.h"

#include <gtest/gtest.h>

#include <cmath>

#include "relume/basis/direction_set.h"

namespace relume::bake {
namespace {

/// Two charts: 16 x 16 texels that face +y, 8 x 4 texels that face (1, 1, 0).
atlas::Texels twoCharts() {
  atlas::Texels texels;
  texels.width = 32, texels.height = 32, texels.pages = 1;
  const auto add = [&](std::uint32_t x, std::uint32_t y, std::uint32_t chart, Normal n) {
    atlas::SurfacePoint p;
    p.texel = y * 32 + x, p.chart = chart, p.area = 1, p.shading_normal = p.geometric_normal = n;
    texels.points.push_back(p);
  };
  for (std::uint32_t y = 0; y < 16; ++y)
    for (std::uint32_t x = 0; x < 16; ++x) add(x, y, 0, {0, 1, 0});
  for (std::uint32_t y = 20; y < 24; ++y)
    for (std::uint32_t x = 10; x < 18; ++x) add(x, y, 1, glm::normalize(Vec3(1, 1, 0)));
  return texels;
}

/// What a map says at a texel, bilinear look-ups aside.
float valueAt(const asset::DirectionMaps& maps, std::size_t chart, std::size_t direction, std::uint32_t x,
              std::uint32_t y, std::size_t channel) {
  const auto& r = maps.at(chart, direction);
  const auto& t = maps.textures[direction];
  const float root = static_cast<float>(t.rgb[3 * ((r.y + y) * t.width + r.x + x) + channel]) / 255.0f;
  return r.most * root * root;
}

TEST(PackDirections, ResolutionFollowsTheProjectedArea) {
  const atlas::Texels texels = twoCharts();
  const std::vector<Direction> set = {{0, 1, 0}, {0, -1, 0}, {0.6f, 0.8f, 0}, {1, 0, 0}};
  const std::vector<float> light(texels.points.size() * set.size() * 3, 1.0f);
  const std::vector<std::uint8_t> valid(texels.points.size(), 1);
  const auto maps = packDirections(texels, set, light, valid, 1.0f);
  EXPECT_EQ(maps.at(0, 0).width, 16u);
  EXPECT_EQ(maps.at(0, 1).width, 0u);   // faces away
  EXPECT_EQ(maps.at(0, 2).width, 14u);  // 16 sqrt 0.8
  EXPECT_EQ(maps.at(0, 3).width, 0u);
  EXPECT_EQ(maps.at(1, 0).width, 7u);  // 8 sqrt cos 45
  EXPECT_EQ(maps.at(1, 0).height, 3u);
  EXPECT_EQ(packDirections(texels, set, light, valid, 0.5f).at(0, 0).width, 8u);
  EXPECT_EQ(maps.charts[1].x, 10u);
  EXPECT_EQ(maps.charts[1].height, 4u);
}

/// Rectangles and their rims lie inside and apart.
TEST(PackDirections, RectanglesDoNotMeet) {
  const atlas::Texels texels = twoCharts();
  const auto set = basis::minimalEnergy(14);
  const std::vector<float> light(texels.points.size() * set.size() * 3, 1.0f);
  const std::vector<std::uint8_t> valid(texels.points.size(), 1);
  const auto maps = packDirections(texels, set, light, valid, 1.0f);
  for (std::size_t d = 0; d < set.size(); ++d) {
    const auto& t = maps.textures[d];
    std::vector<int> owners(std::size_t{t.width} * t.height, 0);
    for (std::size_t c = 0; c < 2; ++c) {
      const auto& r = maps.at(c, d);
      if (r.width == 0) continue;
      ASSERT_LE(r.x + r.width + 1, t.width);
      ASSERT_LE(r.y + r.height + 1, t.height);
      for (std::uint32_t y = r.y - 1; y <= r.y + r.height; ++y)
        for (std::uint32_t x = r.x - 1; x <= r.x + r.width; ++x) EXPECT_EQ(owners[y * t.width + x]++, 0);
    }
  }
}

/// A gradient survives the resampling, bytes and all, and a buried texel takes from its neighbours.
TEST(PackDirections, ValuesAreKept) {
  const atlas::Texels texels = twoCharts();
  const std::vector<Direction> set = {{0, 1, 0}, {0.6f, 0.8f, 0}};
  std::vector<float> light;
  for (const atlas::SurfacePoint& p : texels.points) {
    const float v = p.chart == 0 ? static_cast<float>(p.texel % 32) + 0.5f : 100.0f;
    for (std::size_t k = 0; k < 6; ++k) light.push_back(v);
  }
  std::vector<std::uint8_t> valid(texels.points.size(), 1);
  valid[5] = 0;
  light[5 * 6] = 1e6f;
  const auto maps = packDirections(texels, set, light, valid, 1.0f);
  EXPECT_FLOAT_EQ(maps.at(0, 0).most, 15.5f);  // a bright chart elsewhere costs this one nothing
  for (std::uint32_t x = 0; x < 16; ++x)
    EXPECT_NEAR(valueAt(maps, 0, 0, x, 8, 1), static_cast<float>(x) + 0.5f, 0.07f);
  for (std::uint32_t x = 0; x < 14; ++x)  // 14 texels where there were 16
    EXPECT_NEAR(valueAt(maps, 0, 1, x, 8, 2), (static_cast<float>(x) + 0.5f) * 16 / 14, 0.3f);
  EXPECT_LT(valueAt(maps, 0, 0, 5, 0, 0), 20.0f);
}

}  // namespace
}  // namespace relume::bake
