// SPDX-License-Identifier: MIT
#include "texel_groups.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "made_scenes.h"

namespace relume::transport {
namespace {

TEST(TexelGroups, EveryPointIsInOneGroupOfItsChartAndBlock) {
  atlas::Texels texels = made::texelGrid(70, 39, {}, {1, 0, 0}, {0, 1, 0});
  texels.pages = 3, texels.height = 13;  // a page's last band is one row high
  std::erase_if(texels.points,
                [](const atlas::SurfacePoint& p) { return p.texel % 5 == 1 || p.texel / 70 == 20; });
  for (atlas::SurfacePoint& p : texels.points) p.chart = (p.texel % 70) / 9;
  const TexelGroups groups(texels);
  std::set<std::uint32_t> seen;
  for (std::size_t tile = 0; tile < groups.tiles(); ++tile) {
    groups.forEachGroup(tile, [&](std::span<const std::uint32_t> group) {
      ASSERT_FALSE(group.empty());
      ASSERT_LE(group.size(), kGroupTexels);
      const auto blockOf = [&](std::uint32_t i) {
        const std::uint32_t texel = texels.points[i].texel, row = texel / 70;
        return std::tuple(texels.points[i].chart, row / 13, (row % 13) / kGroupSide, texel % 70 / kGroupSide);
      };
      for (const std::uint32_t i : group) {
        EXPECT_EQ(blockOf(i), blockOf(group[0]));
        EXPECT_TRUE(seen.insert(i).second);
      }
    });
  }
  EXPECT_EQ(seen.size(), texels.points.size());

  EXPECT_EQ(groups.tilesOf({}).size(), groups.tiles());
  const std::vector<std::uint32_t> some = {3, 700, 1201};
  std::size_t found = 0;
  const std::vector<std::size_t> tiles = groups.tilesOf(some);
  EXPECT_LE(tiles.size(), some.size());
  for (const std::size_t tile : tiles)
    groups.forEachGroup(tile, [&](std::span<const std::uint32_t> group) {
      for (const std::uint32_t i : some) found += std::count(group.begin(), group.end(), i);
    });
  EXPECT_EQ(found, some.size());
}

}  // namespace
}  // namespace relume::transport
