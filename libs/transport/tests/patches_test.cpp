// SPDX-License-Identifier: MIT
#include "radiosity/patches.h"

#include <gtest/gtest.h>

#include <numeric>
#include <set>

#include "patched_scene.h"
#include "texel_groups.h"

namespace relume::transport {
namespace {

const std::vector<std::uint8_t> kNoneBuried(1 << 16, 0);

std::span<const std::uint8_t> noneOf(const atlas::Texels& texels) {
  return std::span(kNoneBuried).first(texels.points.size());
}

TEST(Patches, EveryTexelIsInOneAndAreasAddUp) {
  const made::Patched room(made::colouredRoom(true));
  for (const std::uint32_t side : {1u, 3u, 4u, 8u, 64u}) {
    const Patches patches = room.patches(side);
    std::vector<int> seen(room.texels.points.size(), 0);
    double area = 0;
    for (std::uint32_t i = 0; i < patches.size(); ++i) {
      area += static_cast<double>(patches.all[i].area);
      EXPECT_NEAR(glm::length(patches.all[i].normal), 1, 1e-5);
      for (const std::uint32_t point : patches.membersOf(i)) {
        ++seen[point];
        EXPECT_EQ(patches.patch_of[point], i);
        EXPECT_EQ(room.texels.points[point].chart, patches.all[i].chart);
        EXPECT_GT(glm::dot(room.texels.points[point].geometric_normal, patches.all[i].normal), 0.7f);
      }
      std::vector<std::uint32_t> visited;
      patches.forEachGroup(room.texels, i, [&](std::span<const std::uint32_t> group) {
        EXPECT_LE(group.size(), kGroupTexels);
        std::set<std::uint32_t> columns;
        for (const std::uint32_t point : group) {
          const std::uint32_t texel = room.texels.points[point].texel, x = texel % 64, y = texel / 64;
          columns.insert(y % 4 * 4 + x % 4);
        }
        EXPECT_EQ(columns.size(), group.size());
        visited.insert(visited.end(), group.begin(), group.end());
      });
      EXPECT_TRUE(std::ranges::equal(visited, patches.membersOf(i)));
    }
    EXPECT_EQ(std::count(seen.begin(), seen.end(), 1), std::ssize(seen));
    // Six faces of 4 m^2, and a block's of 0.72 + 4 * 0.72 m^2.
    EXPECT_NEAR(area, 24 + 2 * 0.36 + 4 * 0.72, 2e-2);
  }
}

TEST(Patches, OfAWholeGridHaveTheirMiddleAndMeans) {
  const atlas::Texels texels = made::texelGrid(8, 8, {1, 2, 0}, {0.5f, 0, 0}, {0, 0.25f, 0});
  const Patches patches = makePatches(texels, 4, noneOf(texels));
  ASSERT_EQ(patches.size(), 4u);
  EXPECT_LT(glm::length(patches.all[3].centre - Point(4, 3.5f, 0)), 1e-5f);
  EXPECT_FLOAT_EQ(patches.all[3].area, 2.0f);
  std::vector<Vec3> values;
  for (const atlas::SurfacePoint& p : texels.points) values.push_back(p.position);
  EXPECT_LT(glm::length(patches.means(texels, values)[3] - Vec3(4, 3.5f, 0)), 1e-5f);
}

TEST(Patches, BuriedTexelsAreNoMembers) {
  const atlas::Texels texels = made::texelGrid(8, 4, Point(0), {1, 0, 0}, {0, 1, 0});
  std::vector<std::uint8_t> buried(texels.points.size(), 0);
  for (std::size_t i = 0; i < buried.size(); ++i)
    buried[i] = i % 8 < 6;  // the left patch and half of the other
  const Patches patches = makePatches(texels, 4, buried);
  ASSERT_EQ(patches.size(), 2u);
  EXPECT_EQ(patches.all[0].count, 16u);
  EXPECT_EQ(patches.all[1].count, 8u);
  EXPECT_EQ(patches.patch_of[4], 1u);
}

TEST(Patches, ChartsRoundAnEdgeAreDivided) {
  atlas::Texels texels = made::texelGrid(4, 4, Point(0), {1, 0, 0}, {0, 1, 0});
  for (std::size_t i = 8; i < 16; ++i)
    texels.points[i].geometric_normal = texels.points[i].shading_normal = {1, 0, 0};
  const Patches patches = makePatches(texels, 4, noneOf(texels));
  ASSERT_EQ(patches.size(), 2u);
  EXPECT_EQ(patches.all[0].normal, Normal(0, 0, 1));
  EXPECT_EQ(patches.all[1].normal, Normal(1, 0, 0));
  EXPECT_EQ(parentsOf(patches).area.size(), 2u);
}

TEST(Patches, ParentsAreThePatchesOfTwiceTheSide) {
  const made::Patched room(made::colouredRoom(true));
  const Patches fine = room.patches(4), coarse = room.patches(8);
  const Parents parents = parentsOf(fine);
  ASSERT_EQ(parents.area.size(), coarse.size());
  // One to one, with the same members.
  std::vector<std::uint32_t> same(parents.area.size(), scene::kNone);
  for (std::uint32_t i = 0; i < fine.size(); ++i)
    for (const std::uint32_t point : fine.membersOf(i)) {
      std::uint32_t& to = same[parents.of[i]];
      if (to == scene::kNone) to = coarse.patch_of[point];
      EXPECT_EQ(to, coarse.patch_of[point]);
    }
  for (std::size_t k = 0; k < same.size(); ++k) EXPECT_NEAR(parents.area[k], coarse.all[same[k]].area, 1e-5f);
}

}  // namespace
}  // namespace relume::transport
