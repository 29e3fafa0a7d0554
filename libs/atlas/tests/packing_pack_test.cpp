// SPDX-License-Identifier: MIT
#include "charts/pack.h"

#include <gtest/gtest.h>

#include <numeric>

#include "charts_check.h"

namespace relume::atlas {
namespace {

using namespace test;

/// Rectangles as blocks, each of two triangles.
struct Rectangles {
  std::vector<std::vector<Vec2>> uv;
  std::vector<UVec3> triangles{{0, 1, 2}, {0, 2, 3}};
  std::vector<std::uint32_t> members{0, 1};
  std::vector<Block> blocks;

  explicit Rectangles(const std::vector<Vec2>& sizes, const std::vector<std::uint32_t>& groups = {}) {
    for (const Vec2 s : sizes) uv.push_back({{0, 0}, {s.x, 0}, s, {0, s.y}});
    for (std::size_t i = 0; i < sizes.size(); ++i) {
      blocks.push_back({uv[i], triangles, members, sizes[i], 1.0, groups.empty() ? 0u : groups[i]});
    }
  }
};

Packing pack(const Rectangles& r, std::uint32_t groups, const PackOptions& options) {
  SilentProgress progress;
  return packBlocks(r.blocks, groups, options, progress);
}

void expectApart(const Packing& packing, const PackOptions& options) {
  for (std::size_t i = 0; i < packing.placements.size(); ++i) {
    const Placement& a = packing.placements[i];
    EXPECT_LT(a.page, packing.pages);
    EXPECT_TRUE(a.corner.x >= 0 && a.corner.y >= 0);
    EXPECT_TRUE(a.corner.x + a.turnedSize().x <= options.page_size &&
                a.corner.y + a.turnedSize().y <= options.page_size);
    for (std::size_t j = 0; j < i; ++j) {
      const Placement& b = packing.placements[j];
      if (a.page != b.page) continue;
      const auto gap = [](int a0, int a1, int b0, int b1) { return std::max(b0 - a1, a0 - b1); };
      const int dx =
          gap(a.corner.x, a.corner.x + a.turnedSize().x, b.corner.x, b.corner.x + b.turnedSize().x);
      const int dy =
          gap(a.corner.y, a.corner.y + a.turnedSize().y, b.corner.y, b.corner.y + b.turnedSize().y);
      EXPECT_GE(std::max(dx, dy), options.gutter) << i << " and " << j;
    }
  }
}

// Nine equal squares on a page: three by three, with two gutters and half a gutter at each border.
TEST(Packing, EqualSquaresFillThePage) {
  const Rectangles squares(std::vector<Vec2>(9, Vec2(1)));
  PackOptions options;
  options.page_size = 256;
  const Packing packing = pack(squares, 1, options);
  EXPECT_EQ(packing.pages, 1u);
  expectApart(packing, options);
  const double best = (256 - 2 - 2 * 2) / 3;  // whole texels per square
  EXPECT_GT(packing.texels_per_metre, 0.98 * best);
  EXPECT_LE(packing.texels_per_metre, best);
}

TEST(Packing, OneLongStripIsAsLongAsThePage) {
  PackOptions options;
  options.page_size = 128;
  const Packing packing = pack(Rectangles({Vec2(10, 0.1f)}), 1, options);
  EXPECT_NEAR(packing.texels_per_metre, 12.6, 0.05);
}

TEST(Packing, GivenDensityTakesAsManyPagesAsItNeeds) {
  std::vector<Vec2> sizes;
  std::vector<std::uint32_t> groups;
  for (std::uint32_t i = 0; i < 24; ++i) {
    sizes.push_back({1.0f + 0.1f * static_cast<float>(i % 5), 0.5f + 0.1f * static_cast<float>(i % 3)});
    groups.push_back(i / 4);
  }
  const Rectangles r(sizes, groups);
  PackOptions options;
  options.page_size = 128;
  options.texels_per_metre = 40;
  const Packing packing = pack(r, 6, options);
  expectApart(packing, options);
  EXPECT_GE(packing.pages, 2u);
  EXPECT_LE(packing.pages, 4u);
  for (std::size_t i = 0; i < r.blocks.size(); ++i) {
    EXPECT_EQ(packing.placements[i].page, packing.placements[i / 4 * 4].page) << "a group is torn";
    EXPECT_FLOAT_EQ(packing.placements[i].scale, 40.0f);
  }
  for (const double scale : packing.group_scale) EXPECT_EQ(scale, 1.0);
}

TEST(Packing, AGroupLargerThanAPageIsScaledDown) {
  const Rectangles r({Vec2(10, 1), Vec2(1, 1), Vec2(0.5f, 0.5f)}, {0, 0, 1});
  PackOptions options;
  options.page_size = 128;
  options.texels_per_metre = 50;
  const Packing packing = pack(r, 2, options);
  expectApart(packing, options);
  EXPECT_NEAR(packing.group_scale[0], 126.0 / 500, 0.01);
  EXPECT_EQ(packing.group_scale[1], 1.0);
  EXPECT_FLOAT_EQ(packing.placements[2].scale, 50.0f);
}

TEST(Packing, TinyBlocksKeepATexel) {
  std::vector<Vec2> sizes(200, Vec2(1e-6f));
  sizes.push_back(Vec2(1));
  const Packing packing = pack(Rectangles(sizes), 1, PackOptions{64, 2, 0});
  EXPECT_EQ(packing.pages, 1u);
  expectApart(packing, PackOptions{64, 2, 0});
}

TEST(Packing, MoreChartsThanAPageHoldsIsAnError) {
  const Rectangles r(std::vector<Vec2>(500, Vec2(1)));
  try {
    pack(r, 1, PackOptions{32, 2, 0});
    FAIL();
  } catch (const Error& e) {
    EXPECT_EQ(e.code(), ErrorCode::kUsage);
  }
  // In several groups they spread over pages.
  std::vector<std::uint32_t> groups(500);
  std::iota(groups.begin(), groups.end(), 0u);
  const Packing packing =
      pack(Rectangles(std::vector<Vec2>(500, Vec2(1)), groups), 500, PackOptions{32, 2, 0});
  EXPECT_GT(packing.pages, 1u);
  expectApart(packing, PackOptions{32, 2, 0});
}

TEST(Packing, PlacementsTurnWithinTheirBox) {
  Placement p;
  p.corner = {10, 20};
  p.size = {8, 3};
  p.scale = 2;
  p.shift = {0.5f, 0.25f};
  const Vec2 uv(1, 1);  // (2.5, 2.25) in the box
  EXPECT_EQ(place(p, uv), Vec2(12.5f, 22.25f));
  p.turns = 1;
  EXPECT_EQ(place(p, uv), Vec2(10.75f, 22.5f));
  p.turns = 2;
  EXPECT_EQ(place(p, uv), Vec2(15.5f, 20.75f));
  p.turns = 3;
  EXPECT_EQ(place(p, uv), Vec2(12.25f, 25.5f));
  EXPECT_EQ(p.turnedSize(), IVec2(3, 8));
}

}  // namespace
}  // namespace relume::atlas
