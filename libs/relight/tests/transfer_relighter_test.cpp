// SPDX-License-Identifier: MIT
#include "relume/relight/transfer_relighter.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "made_bake.h"
#include "made_lights.h"
#include "relume/core/error.h"
#include "relume/core/parallel.h"

namespace relume::relight {
namespace {

std::vector<Irradiance> copy(std::span<const Irradiance> values) { return {values.begin(), values.end()}; }

// Point p of light l is seen by a share that anybody can compute.
float share(std::size_t light, std::size_t point) { return static_cast<float>((7 * light + point) % 5) / 4; }

TEST(TransferRelighter, MakesUpForShortWays) {
  asset::Asset bake = madeBake({.columns = 90}, 4, 5);
  TransferRelighter whole(bake, bake.layers[0]);
  asset::Transfer transfer = asset::readTransfer(bake.layers[0], bake.atlas);
  const std::size_t texels = bake.atlas.texel.size();
  for (std::size_t i = 0; i < texels; ++i)
    transfer.near_share.push_back(Vec3(i % 3, i % 5, 0) * (51.0f / 255));
  bake.layers[0].tables = asset::transferTables(transfer, bake.atlas);
  TransferRelighter relighter(bake, bake.layers[0]);
  EXPECT_FALSE(whole.leavesShortWays());
  ASSERT_TRUE(relighter.leavesShortWays());
  ASSERT_EQ(relighter.visibilityPoints().size(), 90 * 5 + texels);
  LightSet lights = someLights(12);
  const VisibilitySource visibility = [&](std::size_t light, std::span<float> v) {
    for (std::size_t i = 0; i < v.size(); ++i) v[i] = share(light, i);
  };
  for (const int again : {0, 1}) {  // the second time under other lights
    if (again == 1) lights[3].position.x += 1, lights[5].intensity *= 2;
    const auto far = copy(whole.evaluate(lights, visibility));
    const auto got = relighter.evaluate(lights, visibility);
    ASSERT_EQ(relighter.entryIrradiance(lights, visibility).size(), 90u);
    for (std::size_t i = 0; i < texels; ++i) {
      Vec3 direct(0);
      for (std::size_t l = 0; l < lights.size(); ++l)
        direct += share(l, 90 * 5 + i) *
                  directIrradiance(lights[l], bake.atlas.position[i], bake.atlas.normal[i]).rgb;
      for (int c = 0; c < 3; ++c) {
        const float near = transfer.near_share[i][c];
        const float expected = (far[i].rgb[c] + near * direct[c]) / (1 - near);
        EXPECT_NEAR(got[i].rgb[c], expected, 2e-5f * (1 + std::abs(expected))) << i;
      }
    }
  }
  // Shares that are not one for each texel, or all of the light, are refused.
  transfer.near_share.pop_back();
  EXPECT_THROW(asset::transferTables(transfer, bake.atlas), Error);
  transfer.near_share.push_back(Vec3(1));
  EXPECT_THROW(asset::transferTables(transfer, bake.atlas), Error);
}

void expectMixedEntries(std::uint32_t patch_entries) {
  SCOPED_TRACE(patch_entries);
  const asset::Asset bake = madeBake({.columns = 90}, 4, 5, patch_entries);
  TransferRelighter relighter(bake, bake.layers[0]);
  ASSERT_EQ(relighter.entryCount(), 90u);
  ASSERT_EQ(relighter.pointsPerPatch(), 5u);
  const asset::Entries& entries = relighter.entries();
  ASSERT_EQ(entries.patches(), 90u / patch_entries);
  const LightSet lights = someLights(12);
  const VisibilitySource visibility = [](std::size_t light, std::span<float> v) {
    for (std::size_t i = 0; i < v.size(); ++i) v[i] = share(light, i);
  };
  for (const bool seen : {true, false}) {
    const auto got = relighter.entryIrradiance(lights, seen ? VisibilitySource() : visibility);
    for (std::size_t e = 0; e < 90; ++e) {
      Vec3 expected(0), size(0);
      const std::size_t patch = e / patch_entries, mode = e % patch_entries;
      for (std::size_t l = 0; l < lights.size(); ++l)
        for (std::size_t k = 0; k < 5; ++k) {
          const std::size_t i = 5 * patch + k;
          const float mix = patch_entries == 1 ? 0.2f : entries.mix[i * patch_entries + mode];
          const Vec3 part =
              (seen ? 1 : share(l, i)) * mix *
              directIrradiance(lights[l], relighter.entryPoints()[i], relighter.entryNormals()[i]).rgb;
          expected += part, size += glm::abs(part);
        }
      for (int c = 0; c < 3; ++c) EXPECT_NEAR(got[e].rgb[c], expected[c], 2e-5f * (1 + size[c])) << e;
    }
  }
}

TEST(TransferRelighter, EntriesAreMixedFromDirectLightAtThePointsOfTheirPatch) {
  expectMixedEntries(1);  // means
  expectMixedEntries(3);
}

TEST(TransferRelighter, ExitsAreTheTransferOfTheEntries) {
  const asset::Asset bake = madeBake({}, 4, 3, 2);  // entries below 0 too
  const asset::Transfer t = asset::readTransfer(bake.layers[0], bake.atlas);
  TransferRelighter relighter(bake, bake.layers[0]);
  const auto entries = copy(relighter.entryIrradiance(someLights(9)));
  std::vector<float> in, expected(300);
  for (std::size_t e = 0; e < 40; ++e)
    for (int c = 0; c < 3; ++c) in.push_back(entries[e].rgb[c]);
  codec::multiply(t.matrix, in, expected);
  float largest = 0;
  for (const float v : expected) largest = std::max(largest, std::abs(v));
  const auto exits = relighter.relight(entries);
  ASSERT_EQ(exits.size(), 100u);
  for (std::size_t i = 0; i < 300; ++i)
    EXPECT_NEAR(exits[i / 3].rgb[static_cast<int>(i % 3)], expected[i], 3e-4f * largest) << i;
}

// Whatever was shown before, and with any number of threads.
TEST(TransferRelighter, TheSameLightsGiveTheSameBits) {
  const asset::Asset bake = madeBake({.rows = 300, .columns = 120});
  const LightSet lights = someLights(7);
  const VisibilitySource visibility = [](std::size_t light, std::span<float> v) {
    for (std::size_t i = 0; i < v.size(); ++i) v[i] = share(light, i);
  };
  TransferRelighter fresh(bake, bake.layers[0]);
  const auto expected = copy(fresh.evaluate(lights, visibility));
  TransferRelighter used(bake, bake.layers[0]);
  LightSet others = lights;
  for (int step = 0; step < 20; ++step) {
    others[static_cast<std::size_t>(step) % 7].position.x += 0.3f;
    others[static_cast<std::size_t>(step + 3) % 7].intensity *= 1.5f;
    if (step % 5 == 4) others.pop_back();
    used.evaluate(others, step % 3 == 0 ? VisibilitySource() : visibility);
    ASSERT_EQ(copy(used.evaluate(lights, visibility)), expected) << step;
  }
  for (const int threads : {1, 2, 3}) {
    const ThreadLimit limit(threads);
    TransferRelighter other(bake, bake.layers[0]);
    EXPECT_EQ(copy(other.evaluate(lights, visibility)), expected) << threads;
  }
}

TEST(TransferRelighter, AsksOnlyAboutLightsThatMoved) {
  const asset::Asset bake = madeBake({});
  TransferRelighter relighter(bake, bake.layers[0]);
  std::vector<std::size_t> asked;
  const VisibilitySource visibility = [&](std::size_t light, std::span<float> v) {
    EXPECT_EQ(v.size(), relighter.entryPoints().size());
    std::fill(v.begin(), v.end(), 1.0f);
    asked.push_back(light);
  };
  const auto askedFor = [&](const LightSet& lights) {
    asked.clear();
    relighter.evaluate(lights, visibility);
    return asked;
  };
  using Indices = std::vector<std::size_t>;
  LightSet lights = someLights(5);
  EXPECT_EQ(askedFor(lights), (Indices{0, 1, 2, 3, 4}));
  EXPECT_EQ(askedFor(lights), Indices());
  lights[1].intensity *= 2, lights[2].colour.r = 0, lights[3].name = "new";
  EXPECT_EQ(askedFor(lights), Indices());
  lights[3].position.x += 0.1f, lights[4].range = 3;
  EXPECT_EQ(askedFor(lights), (Indices{3, 4}));
  relighter.forgetVisibility();
  EXPECT_EQ(askedFor(lights), (Indices{0, 1, 2, 3, 4}));
  relighter.evaluate(lights);  // without visibility: another question
  EXPECT_EQ(askedFor(lights), (Indices{0, 1, 2, 3, 4}));
  lights.pop_back();
  EXPECT_EQ(askedFor(lights), Indices());
}

TEST(TransferRelighter, RefusesLightsThatMakeNoSenseAndKeepsWhatWas) {
  const asset::Asset bake = madeBake({});
  TransferRelighter relighter(bake, bake.layers[0]);
  const LightSet lights = someLights(8);
  const auto entries = copy(relighter.entryIrradiance(lights));
  const auto exits = copy(relighter.relight(entries));
  const auto refused = [&](std::size_t which, const auto& change, const VisibilitySource& visibility = {}) {
    LightSet bad = lights;
    change(bad[which]);
    try {
      relighter.evaluate(bad, visibility);
      return false;
    } catch (const Error& e) {
      return e.code() == ErrorCode::kInvalidValue &&
             e.subject().find(std::to_string(which)) != std::string::npos;
    }
  };
  const float nan = std::nanf("");
  EXPECT_FALSE(refused(0, [](Light&) {}));
  EXPECT_TRUE(refused(0, [](Light& l) { l.intensity = -1; }));
  EXPECT_TRUE(refused(4, [&](Light& l) { l.intensity = nan; }));
  EXPECT_TRUE(refused(1, [](Light& l) { l.intensity = kInfinity; }));
  EXPECT_TRUE(refused(1, [](Light& l) { l.colour.g = -0.1f; }));
  EXPECT_TRUE(refused(1, [](Light& l) { l.colour = Vec3(1e30f), l.intensity = 1e30f; }));
  EXPECT_TRUE(refused(0, [&](Light& l) { l.position.z = nan; }));
  EXPECT_TRUE(refused(2, [](Light& l) { l.direction = Vec3(0); }));
  EXPECT_TRUE(refused(0, [](Light& l) { l.range = 0; }));
  EXPECT_TRUE(refused(3, [](Light& l) { l.area = -2; }));
  EXPECT_TRUE(refused(1, [&](Light& l) { l.outer_cone = nan; }));
  const auto moved = [](Light& l) { l.position.y += 0.1f; };
  EXPECT_TRUE(refused(4, moved, [](std::size_t light, std::span<float> v) {
    std::fill(v.begin(), v.end(), light == 4 ? -0.5f : 1.0f);
  }));
  EXPECT_TRUE(refused(4, moved, [&](std::size_t light, std::span<float> v) {
    std::fill(v.begin(), v.end(), light == 4 ? nan : 1.0f);
  }));
  LightSet bright = lights;
  bright[0].intensity = 1e30f;
  EXPECT_THROW(relighter.entryIrradiance(bright), Error);
  auto wrong = entries;
  wrong[5].rgb.g = nan;
  EXPECT_THROW(relighter.relight(wrong), Error);
  EXPECT_EQ(copy(relighter.relight(entries)), exits);
  EXPECT_EQ(copy(relighter.entryIrradiance(lights)), entries);
}

// A transfer of one component, whose planes are what the exits shall have: red grows with the column, green
// with the row of the block; blue tells the charts apart.
asset::Asset fieldOfBlocks(std::uint32_t side) {
  asset::Asset bake =
      madeBake({.tiles = 1, .clusters = 1, .rank = 1, .overlap = 0, .exact_rank = true}, side);
  asset::Transfer t = asset::readTransfer(bake.layers[0], bake.atlas);
  for (std::uint32_t exit = 0; exit < 100; ++exit) {
    t.matrix.planes8[exit] = static_cast<std::int8_t>(exit % 10);
    t.matrix.planes8[100 + exit] = static_cast<std::int8_t>(exit / 10);
    t.matrix.planes8[200 + exit] = exit % 10 < 5 ? 20 : 0;
  }
  std::fill(t.matrix.weights8.begin(), t.matrix.weights8.end(), std::int8_t{127});
  t.matrix.scale[0] = 1;
  bake.layers[0].tables = asset::transferTables(t, bake.atlas);
  return bake;
}

TEST(TransferRelighter, TexelsAreBilinearWithinTheirChart) {
  for (const std::uint32_t side : {1u, 4u, 5u}) {
    const asset::Asset bake = fieldOfBlocks(side);
    TransferRelighter relighter(bake, bake.layers[0]);
    for (const Irradiance& e : relighter.texels()) EXPECT_EQ(e, Irradiance());
    std::vector<Irradiance> unit(40);
    unit[17] = Irradiance(1.0f);
    relighter.relight(unit);
    const auto texels = relighter.texels();
    for (std::size_t i = 0; i < texels.size(); ++i) {
      const std::uint32_t width = 10 * side, x = bake.atlas.texel[i] % width, y = bake.atlas.texel[i] / width;
      // Beyond the middle of a chart's last block its value holds.
      const auto along = [&](std::uint32_t texel, float first, float last) {
        return std::clamp((static_cast<float>(texel) + 0.5f) / static_cast<float>(side) - 0.5f, first, last);
      };
      EXPECT_NEAR(texels[i].rgb.r, x < width / 2 ? along(x, 0, 4) : along(x, 5, 9), 1e-3f) << x << ' ' << y;
      EXPECT_NEAR(texels[i].rgb.g, along(y, 0, 9), 1e-3f) << x << ' ' << y;
      EXPECT_NEAR(texels[i].rgb.b, x < width / 2 ? 20 : 0, 1e-3f) << x << ' ' << y;
    }
  }
}

// Over an edge within a chart nothing blends.
TEST(TransferRelighter, BlocksThatFaceElsewhereDoNotBlend) {
  asset::Asset bake = fieldOfBlocks(4);
  for (std::size_t i = 0; i < bake.atlas.texel.size(); ++i)
    if (bake.atlas.texel[i] % 40 >= 8) bake.atlas.normal[i] = {1, 0, 0};
  TransferRelighter relighter(bake, bake.layers[0]);
  std::vector<Irradiance> unit(40);
  unit[0] = Irradiance(1.0f);
  relighter.relight(unit);
  const auto texels = relighter.texels();
  for (std::size_t i = 0; i < texels.size(); ++i) {
    const std::uint32_t x = bake.atlas.texel[i] % 40;
    if (x < 6 || x >= 10) continue;
    EXPECT_NEAR(texels[i].rgb.r, x < 8 ? 1 : 2, 1e-3f) << x;
  }
}

TEST(TransferRelighter, LayersWithoutTransferAreAMismatch) {
  asset::Asset bake = madeBake({});
  bake.layers[0].tables.clear();
  try {
    TransferRelighter relighter(bake, bake.layers[0]);
    FAIL();
  } catch (const Error& e) {
    EXPECT_EQ(e.code(), ErrorCode::kMismatch);
  }
}

// Numbers of tables changed at random, as a file with sound checksums might have them: a clear error, or
// light that is finite.
TEST(TransferRelighter, ChangedTablesAreRefusedOrHarmless) {
  const asset::Asset sound = madeBake({.rows = 60, .columns = 20, .rank = 3});
  const LightSet lights = someLights(3);
  std::mt19937 random(17);
  int refused = 0;
  constexpr int kRuns = 3000;
  for (int run = 0; run < kRuns; ++run) {
    asset::Asset bake = sound;
    auto& tables = bake.layers[0].tables;
    std::visit(
        [&](auto& values) {
          using T = typename std::remove_reference_t<decltype(values)>::value_type;
          if (run % 10 == 0) values.resize(random() % (2 * values.size() + 1));
          for (unsigned k = random() % 3 + 1; k > 0 && !values.empty(); --k) {
            T& value = values[random() % values.size()];
            if constexpr (std::is_floating_point_v<T>)
              value = std::ldexp(static_cast<float>(random()), static_cast<int>(random() % 200) - 130);
            else
              value = static_cast<T>(random() % 2 ? random() : value + random() % 3 - 1);
          }
        },
        tables[random() % tables.size()].values);
    try {
      TransferRelighter relighter(bake, bake.layers[0]);
      for (const Irradiance& e : relighter.evaluate(lights)) ASSERT_TRUE(isFinite(e.rgb)) << "run " << run;
    } catch (const Error& e) {
      ASSERT_TRUE(e.code() == ErrorCode::kCorruptAsset || e.code() == ErrorCode::kInvalidValue) << e.what();
      ++refused;
    }
  }
  EXPECT_GT(refused, kRuns / 4);
  EXPECT_LT(refused, kRuns);
}

TEST(TransferRelighter, EveryTruncatedFileIsRefused) {
  const auto file = asset::encodeGlb(madeBake({.rows = 20, .columns = 8, .rank = 2}));
  for (std::size_t size = 0; size < file.size(); ++size)
    ASSERT_THROW(asset::decode(std::span(file).first(size), "cut"), Error) << size;
}

}  // namespace
}  // namespace relume::relight
