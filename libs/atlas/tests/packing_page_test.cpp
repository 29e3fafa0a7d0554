// SPDX-License-Identifier: MIT
#include "charts/page.h"

#include <gtest/gtest.h>

#include <random>

#include "charts/centre_counter.h"
#include "charts_check.h"

namespace relume::atlas {
namespace {

using namespace test;

TEST(PackingFootprint, CoverageIsThatOfClipping) {
  std::mt19937 random(5);
  const auto number = [&](float size) { return size * static_cast<float>(random() % 100000) * 1e-5f; };
  for (int i = 0; i < 3000; ++i) {
    const float size = i % 3 == 0 ? 3.0f : 70.0f;
    const std::array<Vec2, 3> p = {Vec2(number(size), number(size)), Vec2(number(size), number(size)),
                                   Vec2(number(size), number(size))};
    BitGrid grid(70, 70);
    coverTriangle(grid, p[0], p[1], p[2]);
    const std::array<D2, 3> q = {D2(p[0]), D2(p[1]), D2(p[2])};
    for (int y = 0; y < 70; ++y) {
      for (int x = 0; x < 70; ++x) {
        const double area = areaInTexel(q, x, y);
        // Within rounding of nothing either answer is right.
        if (area > 1e-6) {
          EXPECT_TRUE(grid.get(x, y));
        }
        if (area == 0 && grid.get(x, y)) {
          BitGrid shrunk(70, 70);
          coverTriangle(shrunk, p[0], p[1], p[2], -1e-4f);
          EXPECT_FALSE(shrunk.get(x, y)) << x << ' ' << y;
        }
      }
    }
  }
}

TEST(PackingFootprint, RunsAndQuarterTurns) {
  BitGrid grid(130, 3);
  grid.setRun(0, 0, 130);
  grid.setRun(1, 63, 65);
  grid.set(129, 2);
  const Footprint footprint = footprintOf(grid);
  ASSERT_EQ(footprint.runs.size(), 3u);
  EXPECT_EQ(footprint.runs[1].begin, 63);
  EXPECT_EQ(footprint.runs[1].length, 2);
  EXPECT_EQ(footprint.runs[2].begin, 129);
  EXPECT_EQ(footprint.texels, 133u);
  const BitGrid turned = quarterTurn(grid);
  EXPECT_EQ(turned.width(), 3);
  EXPECT_TRUE(turned.get(0, 129));
  EXPECT_TRUE(turned.get(1, 64));
  BitGrid whole = grid;
  for (int i = 0; i < 4; ++i) whole = quarterTurn(whole);
  for (int y = 0; y < 3; ++y) {
    for (int x = 0; x < 130; ++x) EXPECT_EQ(whole.get(x, y), grid.get(x, y));
  }
}

Footprint randomShape(std::mt19937& random, int largest) {
  const int width = 1 + static_cast<int>(random() % static_cast<unsigned>(largest));
  const int height = 1 + static_cast<int>(random() % static_cast<unsigned>(largest));
  BitGrid grid(width, height);
  const auto inside = [&](int size) {
    return static_cast<float>(random() % static_cast<unsigned>(size + 1));
  };
  for (int i = 0; i < 3; ++i) {
    coverTriangle(grid, {inside(width), inside(height)}, {inside(width), inside(height)},
                  {inside(width), inside(height)}, 0.01f);
  }
  return footprintOf(grid);
}

// The fast search against one that tries every place.
TEST(PackingPage, FindsTheFirstFreePlace) {
  std::mt19937 random(7);
  constexpr int kWidth = 200, kHeight = 90;
  for (int round = 0; round < 12; ++round) {
    Occupancy page(kWidth, kHeight);
    BitGrid taken(kWidth, kHeight);
    for (int i = 0; i < 60; ++i) {
      const Shape shape = prepareShape(randomShape(random, round % 2 == 0 ? 14 : 80));
      std::optional<IVec2> expected;
      const Footprint& f = shape.footprint;
      for (int y = 0; y + f.height <= kHeight && !expected; ++y) {
        for (int x = 0; x + f.width <= kWidth && !expected; ++x) {
          const bool free = std::all_of(f.runs.begin(), f.runs.end(), [&](const auto& run) {
            for (int k = 0; k < run.length; ++k) {
              if (taken.get(x + run.begin + k, y + run.row)) return false;
            }
            return true;
          });
          if (free) expected = IVec2(x, y);
        }
      }
      const std::optional<IVec2> found = page.find(shape, kHeight - 1);
      ASSERT_EQ(found.has_value(), expected.has_value() && !f.runs.empty());
      if (!found) continue;
      ASSERT_EQ(*found, *expected) << "round " << round << " shape " << i;
      for (const auto& run : f.runs) {
        const int y = found->y + run.row, x = found->x + run.begin;
        taken.setRun(y, x, x + run.length);
        page.occupyRun(y, x, x + run.length);
        page.refresh(y, x, x + run.length);
      }
    }
  }
}

// Whatever the grid it is placed on, a footprint keeps its gutter.
TEST(PackingPage, KeepsGuttersHoweverItSearches) {
  for (const Page::Search search : {Page::Search::kEverywhere, Page::Search::kCoarse, Page::Search::kHasty}) {
    for (const int gutter : {0, 1, 2, 5}) {
      std::mt19937 random(11);
      Page page(600, 500, gutter, search);
      std::vector<std::uint32_t> owner(600 * 500, kNone);
      Atlas atlas;
      atlas.width = 600, atlas.height = 500, atlas.pages = 1;
      std::uint32_t placed = 0;
      for (std::uint32_t i = 0; i < 150; ++i) {
        const Footprint footprint = randomShape(random, i < 20 ? 180 : 30);
        if (footprint.runs.empty()) continue;
        const std::optional<Page::Place> place = page.find(footprint);
        if (!place) continue;
        page.occupy(footprint, *place);
        ++placed;
        BitGrid grid(footprint.width, footprint.height);
        for (const auto& run : footprint.runs) grid.setRun(run.row, run.begin, run.begin + run.length);
        for (int t = 0; t < place->turns; ++t) grid = quarterTurn(grid);
        for (int y = 0; y < grid.height(); ++y) {
          for (int x = 0; x < grid.width(); ++x) {
            if (!grid.get(x, y)) continue;
            const int px = place->corner.x + x, py = place->corner.y + y;
            ASSERT_TRUE(px >= gutter / 2 && py >= gutter / 2 && px < 600 - gutter / 2 &&
                        py < 500 - gutter / 2);
            std::uint32_t& o = owner[static_cast<std::size_t>(py) * 600 + static_cast<std::size_t>(px)];
            ASSERT_EQ(o, kNone) << "overlap";
            o = i;
          }
        }
      }
      EXPECT_GT(placed, 60u);
      EXPECT_GE(narrowestGutter(atlas, owner, gutter), gutter);
    }
  }
}

TEST(PackingCentres, TouchingTrianglesClaimEveryCentreOnce) {
  // A fan about a texel centre, and edges through centres.
  CentreCounter counter(9, 9);
  const Vec2 c(4.5f, 4.5f);
  const Vec2 rim[] = {{0, 0}, {4.5f, 0}, {9, 0}, {9, 4.5f}, {9, 9}, {4.5f, 9}, {0, 9}, {0, 4.5f}};
  for (int i = 0; i < 8; ++i) {
    // Winding must not matter.
    if (i % 2 == 0) {
      counter.add(c, rim[i], rim[(i + 1) % 8]);
    } else {
      counter.add(c, rim[(i + 1) % 8], rim[i]);
    }
  }
  EXPECT_EQ(counter.claimed(), 81u);
  EXPECT_EQ(counter.claimedTwice(), 0u);
  counter.add({2, 2}, {4, 2}, {2, 4});
  EXPECT_GT(counter.claimedTwice(), 0u);
}

}  // namespace
}  // namespace relume::atlas
