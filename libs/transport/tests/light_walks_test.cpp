// SPDX-License-Identifier: MIT
// The published estimator of the transfer, against closed forms, and the fast one against it. Sums over walls
// may be 4 standard errors of eight independent runs off (Student's t of 7: one false alarm in 380 numbers),
// with fixed seeds, and as far as small elements and the rays of exits make the fast one differ.
#include "light_paths/light_walks.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "lit_scene.h"
#include "made_rooms.h"
#include "relume/transport/light_paths.h"

namespace relume::transport {
namespace {

LightPathOptions small(EntryPlacement placement) {
  LightPathOptions options;
  options.materials = Materials::kLambert, options.placement = placement;
  options.entries = 64, options.elements = 2048, options.exit_side = 6, options.tile_exits = 1 << 16;
  options.exit_rays = 1024, options.element_rays = 512, options.tile_overlap = 0;
  return options;
}

/// One tile: all exits. shape: [exits][3][entries]
std::vector<float> transfer(const LightPaths& paths) {
  EXPECT_EQ(paths.tiles().size(), 1u);
  std::vector<float> rows(paths.exits().size() * 3 * paths.entries().size());
  paths.rows(0, rows);
  return rows;
}

TEST(LightWalks, InASphereEveryPlaceSeesThemAlike) {
  // cos cos / r^2 is 1 / (4 R^2) between any two places: only the number of reflections varies.
  const float rho = 0.6f, radius = 2;
  const made::Lit sphere(made::cavity(radius, 0, Vec3(rho)));
  SilentProgress silent;
  LightPathOptions options = small(EntryPlacement::kPatches);
  options.transfer = TransferBy::kWalks, options.walks = 64, options.exit_side = 32;
  options.patch_entries = 1;  // of which all are 1 under even light
  const LightPaths paths(sphere.tracer, sphere.atlas, sphere.texels, options, silent);
  const std::vector<float> t = transfer(paths);
  double sum = 0, area = 0;
  for (const float v : t) sum += static_cast<double>(v);
  for (const float a : paths.entries().area) area += static_cast<double>(a);
  sum /= 3 * static_cast<double>(paths.exits().size());
  const double expected = rho / (1 - rho);
  // Every walk brings rho A / walks to as many lights as it has steps, geometrically distributed.
  const double walks = 64.0 * static_cast<double>(paths.entries().size());
  const double sigma = rho * std::sqrt(rho) / (1 - rho) / std::sqrt(walks);
  EXPECT_NEAR(sum, expected, 4 * sigma + 0.004 * expected);  // facets
  EXPECT_LT(4 * sigma, 0.06 * expected);
}

/// Where two walls meet connections are short, and their noise has no bound.
bool nearACrease(Point p, float distance) {
  int walls = 0;
  for (int a = 0; a < 3; ++a) walls += p[a] < distance || p[a] > 2 - distance;
  return walls > 1;
}

struct WallSums {
  std::array<double, 18> value{};  // by wall and channel
  static std::size_t wallOf(Normal n) {
    std::size_t axis = 0;
    for (std::size_t a = 1; a < 3; ++a)
      if (std::abs(n[static_cast<int>(a)]) > std::abs(n[static_cast<int>(axis)])) axis = a;
    return 2 * axis + (n[static_cast<int>(axis)] < 0 ? 1 : 0);
  }
};

WallSums sumsOf(const LightPaths& paths, std::span<const float> entry_irradiance, float crease) {
  const std::vector<float> t = transfer(paths);
  const std::size_t entries = paths.entries().size();
  WallSums sums;
  for (std::size_t x = 0; x < paths.exits().size(); ++x) {
    const Exit& exit = paths.exits().all[x];
    if (nearACrease(exit.position, crease)) continue;
    for (std::size_t c = 0; c < 3; ++c)
      for (std::size_t e = 0; e < entries; ++e)
        sums.value[3 * WallSums::wallOf(exit.normal) + c] +=
            static_cast<double>(exit.area) * static_cast<double>(t[(x * 3 + c) * entries + e]) *
            static_cast<double>(entry_irradiance[e]);
  }
  return sums;
}

struct WalkCase {
  EntryPlacement placement;
  float near, crease;
  std::uint32_t entries, walks;
};
class FastTransfer : public testing::TestWithParam<WalkCase> {};

TEST_P(FastTransfer, IsThePublishedOne) {
  const made::Lit room(made::colouredRoom(false), 96);
  SilentProgress silent;
  LightPathOptions options = small(GetParam().placement);
  options.near = GetParam().near, options.entries = GetParam().entries;
  const LightPaths fast(room.tracer, room.atlas, room.texels, options, silent);
  Light lamp;
  lamp.position = {1.2f, 0.7f, 1.1f};
  const LightSet lights = {lamp};
  const std::vector<float> on_entries = fast.entryIrradiance(lights, silent);
  const WallSums expected = sumsOf(fast, on_entries, GetParam().crease);
  constexpr int kRuns = 8;
  std::array<WallSums, kRuns> runs;
  options.transfer = TransferBy::kWalks, options.walks = GetParam().walks;
  for (int run = 0; run < kRuns; ++run) {
    options.walk_seed = static_cast<std::uint64_t>(run) + 1;
    const LightPaths walked(room.tracer, room.atlas, room.texels, options, silent);
    ASSERT_EQ(walked.entries().area, fast.entries().area);
    runs[static_cast<std::size_t>(run)] = sumsOf(walked, on_entries, GetParam().crease);
  }
  for (std::size_t i = 0; i < expected.value.size(); ++i) {
    double mean = 0, square = 0;
    for (const WallSums& run : runs) mean += run.value[i] / kRuns;
    for (const WallSums& run : runs) square += (run.value[i] - mean) * (run.value[i] - mean);
    const double error = std::sqrt(square / (kRuns - 1) / kRuns);
    EXPECT_LT(error, 0.03 * mean);
    EXPECT_NEAR(mean, expected.value[i], 4 * error + 0.01 * expected.value[i])
        << "wall " << i / 3 << " channel " << i % 3;
  }
}

TEST(ShortWays, AreWhatTheTransferLeavesOut) {
  // A furnace: of the indirect irradiance I = rho / (1 - rho) under light of 1 on everything, the transfer
  // has I - c (1 + I), c the share of short ways.
  const float rho = 0.5f;
  const made::Lit furnace(made::box({2, 2, 2}, Vec3(rho), Vec3(0)), 64);
  SilentProgress silent;
  LightPathOptions options = small(EntryPlacement::kPatches);
  options.near = 0.4f, options.patch_entries = 1;  // of which all are 1 under even light
  const LightPaths paths(furnace.tracer, furnace.atlas, furnace.texels, options, silent);
  const std::vector<Vec3> near = paths.nearShares(silent);
  const std::vector<float> t = transfer(paths);
  const std::size_t exits = paths.exits().size(), entries = paths.entries().size();
  std::vector<double> share(exits, 0.0), area(exits, 0.0);
  for (std::size_t i = 0; i < near.size(); ++i) {
    const auto a = static_cast<double>(furnace.texels.points[i].area);
    share[paths.exits().of_texel[i]] += a * static_cast<double>(near[i].x);
    area[paths.exits().of_texel[i]] += a;
    if (!nearACrease(furnace.texels.points[i].position, 0.5f)) {
      EXPECT_EQ(near[i], Vec3(0));
    }
  }
  const double full = rho / (1 - rho);
  double most = 0;
  for (std::size_t x = 0; x < exits; ++x) {
    double far = 0;
    for (std::size_t e = 0; e < entries; ++e) far += static_cast<double>(t[x * 3 * entries + e]);
    const double c = share[x] / area[x];
    most = std::max(most, c);
    EXPECT_NEAR(far + c * (1 + full), full, 0.03 * full) << x;  // two sets of rays
  }
  EXPECT_GT(most, 0.1);
}

INSTANTIATE_TEST_SUITE_P(LightWalks, FastTransfer,
                         testing::Values(WalkCase{EntryPlacement::kPatches, 0.0f, 0.3f, 64, 8},
                                         // Few points are met by few rays of exits.
                                         WalkCase{EntryPlacement::kShot, 0.0f, 0.3f, 1024, 1},
                                         WalkCase{EntryPlacement::kPatches, 0.3f, 0.0f, 64, 8}));

}  // namespace
}  // namespace relume::transport
