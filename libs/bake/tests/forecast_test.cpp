// SPDX-License-Identifier: MIT
// Forecasts of a solver that takes a known time by a clock of its own.
#include "forecast.h"

#include <gtest/gtest.h>

#include <numeric>
#include <set>

#include "relume/core/error.h"

namespace relume::bake {
namespace {

// Two pages, all of whose texels are covered.
atlas::Texels pages(std::uint32_t side) {
  atlas::Texels texels{.width = static_cast<int>(side), .height = static_cast<int>(side), .pages = 2};
  for (std::uint32_t i = 0; i < 2 * side * side; ++i) {
    atlas::SurfacePoint p;
    p.texel = i;
    texels.points.push_back(p);
  }
  return texels;
}

std::vector<std::uint32_t> allOf(const atlas::Texels& texels) {
  std::vector<std::uint32_t> all(texels.points.size());
  std::iota(all.begin(), all.end(), 0u);
  return all;
}

/// Does something that takes `once` seconds before its first texel, then `block` seconds for each block of
/// 4 x 4 that it is asked for a texel of.
struct Timed {
  TexelSolver solver() {
    TexelSolver s;
    s.row = 1;
    s.solve = [this](std::span<const std::uint32_t> which, std::span<float> rows, Progress& progress) {
      EXPECT_EQ(rows.size(), which.size());
      progress.throwIfCancelled();
      if (asked.empty()) seconds += once;
      std::set<std::uint32_t> blocks;
      for (const std::uint32_t i : which) {
        EXPECT_TRUE(asked.insert(i).second) << "solved twice";
        const std::uint32_t texel = texels.points[i].texel, side = static_cast<std::uint32_t>(texels.width);
        blocks.insert(texel / side / 4 * side + texel % side / 4);
      }
      seconds += block * static_cast<double>(blocks.size());
      return std::uint64_t{which.size()};
    };
    return s;
  }
  double forecast(std::span<const std::uint32_t> pending) {
    SilentProgress progress;
    return forecastSeconds(solver(), texels, pending, progress, [this] { return seconds; });
  }
  const atlas::Texels& texels;
  double once = 0, block = 0, seconds = 0;
  std::set<std::uint32_t> asked;
};

TEST(Forecast, WhatIsDoneOnceIsCountedOnce) {
  const atlas::Texels texels = pages(256);
  Timed timed{.texels = texels, .once = 30, .block = 1e-3};
  const double whole = 30 + 1e-3 * static_cast<double>(texels.points.size() / 16);
  EXPECT_NEAR(timed.forecast(allOf(texels)), whole, 1e-6 * whole);
  EXPECT_LT(timed.asked.size(), texels.points.size() / 4) << "a pilot ought to be small";
}

TEST(Forecast, BlocksComeWholeAndFromAllOverTheAtlas) {
  const atlas::Texels texels = pages(512);
  Timed timed{.texels = texels, .once = 1, .block = 1e-4};
  timed.forecast(allOf(texels));
  EXPECT_EQ(timed.asked.size() % 16, 0u);
  // Sixteenths of the two pages, by rows: all have a share that is not far from even.
  std::vector<double> share(16);
  for (const std::uint32_t i : timed.asked)
    share[i / (texels.points.size() / 16)] += 16.0 / static_cast<double>(timed.asked.size());
  for (const double s : share) EXPECT_NEAR(s, 1.0, 0.3);
}

TEST(Forecast, ScatteredTexelsOfAnInterruptedBakeCostTheirBlocks) {
  const atlas::Texels texels = pages(256);
  std::vector<std::uint32_t> pending;
  for (std::uint32_t i = 0; i < texels.points.size(); ++i)
    if (i / 256 % 4 == 1 && i % 4 == 2) pending.push_back(i);  // one of each block
  Timed timed{.texels = texels, .once = 2, .block = 1e-3};
  const double whole = 2 + 1e-3 * static_cast<double>(pending.size());
  EXPECT_NEAR(timed.forecast(pending), whole, 1e-6 * whole);
}

TEST(Forecast, LittleWorkIsDoneAndTimed) {
  const atlas::Texels texels = pages(16);
  Timed timed{.texels = texels, .once = 2, .block = 1e-3};
  EXPECT_NEAR(timed.forecast(allOf(texels)), 2 + 32e-3, 1e-9);
  EXPECT_EQ(Timed{.texels = texels}.forecast({}), 0);
  const std::vector<std::uint32_t> one = {5};
  EXPECT_NEAR((Timed{.texels = texels, .once = 3, .block = 1}.forecast(one)), 4, 1e-9);
}

TEST(Forecast, CanBeInterrupted) {
  const atlas::Texels texels = pages(16);
  Timed timed{.texels = texels};
  SilentProgress progress;
  progress.cancel();
  EXPECT_THROW(forecastSeconds(timed.solver(), texels, allOf(texels), progress), Error);
}

}  // namespace
}  // namespace relume::bake
