// SPDX-License-Identifier: MIT
// Light that leaves at probes and at vertices, as the run time reads it.
#include "probe_field.h"

#include <gtest/gtest.h>

#include <cmath>

#include "made_bake.h"
#include "relume/basis/sh9.h"
#include "relume/core/error.h"
#include "relume/relight/transfer_relighter.h"

namespace relume::relight {
namespace {

asset::ProbeExits grid() {
  asset::ProbeExits probes{.origin = {1, 2, 3}, .spacing = 0.5f, .count = {3, 2, 4}, .probe = {}};
  for (std::uint32_t i = 0; i < 24; ++i) probes.probe.push_back(i);
  return probes;
}

TEST(ProbeField, HoldsWhatDoesNotDependOnThePlace) {
  // E(n) = 2 + n.x at every probe, one of which stands in a body and holds nothing that makes sense.
  asset::ProbeExits probes = grid();
  probes.probe[5] = asset::ProbeExits::kNoProbe;
  std::vector<Irradiance> rows(24 * 9);
  const auto y = basis::sh9({1, 0, 0});
  for (std::size_t p = 0; p < 24; ++p) {
    rows[9 * p] = Irradiance(2 / y[0]), rows[9 * p + 3] = Irradiance(1 / y[3]);
    if (p == 5)
      for (std::size_t k = 0; k < 9; ++k) rows[9 * p + k] = Irradiance(1e6f);
  }
  const ProbeField field(probes);
  for (const Point p : {Point(1, 2, 3), Point(1.7f, 2.2f, 3.9f), Point(-5, 0, 9)})
    for (const Normal n : {Normal(1, 0, 0), Normal(0, 1, 0), glm::normalize(Vec3(-1, 2, 1))})
      EXPECT_NEAR(field.at(p, n, rows).rgb.y, 2 + n.x, 1e-4f);
}

TEST(ProbeField, PassesOverFromProbeToProbe) {
  // Bands 0 alone, a value that grows along z; across the normal the two layers weigh alike.
  std::vector<Irradiance> rows(24 * 9);
  const float y0 = basis::sh9({1, 0, 0})[0];
  for (std::size_t p = 0; p < 24; ++p) rows[9 * p] = Irradiance(static_cast<float>(p / 6) / y0);
  const ProbeField field(grid());
  EXPECT_NEAR(field.at({1.25f, 2.25f, 3.75f}, {1, 0, 0}, rows).rgb.x, 1.5f, 1e-4f);
  EXPECT_NEAR(field.at({1.5f, 2, 4}, {0, 0, 1}, rows).rgb.x, 2, 1e-4f);
  // On a plane that faces up what stands above it counts for more.
  EXPECT_GT(field.at({1.25f, 2.25f, 3.75f}, {0, 0, 1}, rows).rgb.x, 1.8f);
  EXPECT_LT(field.at({1.25f, 2.25f, 3.75f}, {0, 0, -1}, rows).rgb.x, 1.2f);
}

TEST(ProbeField, NothingWhereNoProbeIs) {
  asset::ProbeExits probes = grid();
  std::fill(probes.probe.begin(), probes.probe.end(), asset::ProbeExits::kNoProbe);
  EXPECT_EQ(ProbeField(probes).at({1.2f, 2.1f, 3}, {1, 0, 0}, {}).rgb, Vec3(0));
}

/// A bake whose exits are made others.
asset::Asset withExits(asset::Exits exits, std::uint32_t rows) {
  asset::Asset bake = madeBake({.rows = rows});
  asset::Transfer transfer = asset::readTransfer(bake.layers[0], bake.atlas);
  transfer.exits = std::move(exits);
  bake.layers[0].tables = asset::transferTables(transfer, bake.atlas);
  return asset::decode(asset::encodeGlb(bake), "made");
}

LightSet lamp() {
  LightSet lights(1);
  lights[0].position = {2, 1.5f, 2};
  return lights;
}

TEST(TransferRelighter, LeavesAtProbes) {
  const asset::Asset bake = withExits(
      {.kind = asset::Exits::Kind::kProbes, .side = 0, .exit_of_texel = {}, .vertices = {}, .probes = grid()},
      24 * 9);
  TransferRelighter relighter(bake, bake.layers[0]);
  ASSERT_EQ(relighter.exitKind(), asset::Exits::Kind::kProbes);
  EXPECT_EQ(relighter.probes().count, grid().count);
  const auto texels = relighter.evaluate(lamp());
  ASSERT_EQ(texels.size(), bake.atlas.texel.size());
  bool any = false;
  for (std::size_t i = 0; i < texels.size(); i += 17) {
    EXPECT_EQ(texels[i].rgb, relighter.atProbes(bake.atlas.position[i], bake.atlas.normal[i]).rgb);
    any |= texels[i].rgb != Vec3(0);
  }
  EXPECT_TRUE(any);
}

asset::Exits atVertices(std::size_t texels, std::uint32_t rows) {
  asset::Exits exits{
      .kind = asset::Exits::Kind::kVertices, .side = 0, .exit_of_texel = {}, .vertices = {}, .probes = {}};
  for (std::uint32_t i = 0; i < rows; ++i) {
    exits.vertices.position.emplace_back(i, 0.25f * static_cast<float>(i), 1);
    exits.vertices.normal.push_back(glm::normalize(Vec3(1, i, 0)));
  }
  for (std::uint32_t i = 0; i < texels; ++i) {
    for (const std::uint32_t k : {0u, 1u, 7u}) exits.vertices.texel_exit.push_back((i + k) % rows);
    for (const std::uint8_t w : {std::uint8_t{100}, std::uint8_t{0}, std::uint8_t{155}})
      exits.vertices.texel_weight.push_back(w);
  }
  return exits;
}

TEST(TransferRelighter, LeavesAtVertices) {
  const std::size_t count = madeBake({.rows = 100}).atlas.texel.size();
  const asset::Asset bake = withExits(atVertices(count, 100), 100);
  TransferRelighter relighter(bake, bake.layers[0]);
  ASSERT_EQ(relighter.exitKind(), asset::Exits::Kind::kVertices);
  ASSERT_EQ(relighter.vertices().position.size(), 100u);
  EXPECT_EQ(relighter.vertices().position[3], Point(3, 0.75f, 1));
  EXPECT_NEAR(relighter.vertices().normal[1].x, std::sqrt(0.5f), 1e-3f);
  const auto rows = relighter.relight(relighter.entryIrradiance(lamp()));
  const std::vector<Irradiance> exits(rows.begin(), rows.end());
  const auto texels = relighter.texels();
  for (std::size_t i = 0; i < count; ++i)
    for (int c = 0; c < 3; ++c) {
      const float expected = (100 * exits[i % 100].rgb[c] + 155 * exits[(i + 7) % 100].rgb[c]) / 255;
      EXPECT_NEAR(texels[i].rgb[c], expected, 1e-5f * (1 + std::abs(expected)));
    }
}

TEST(TransferRelighter, RefusesVerticesAndProbesThatMakeNoSense) {
  const std::size_t count = madeBake({.rows = 99}).atlas.texel.size();
  const auto refused = [&](auto change) {
    asset::Exits exits = atVertices(count, 99);
    change(exits);
    try {
      withExits(exits, 99);
    } catch (const Error& e) {
      return e.code() == ErrorCode::kCorruptAsset;
    }
    return false;
  };
  EXPECT_FALSE(refused([](asset::Exits&) {}));
  EXPECT_TRUE(refused([](asset::Exits& e) { e.vertices.texel_exit[5] = 99; }));
  EXPECT_TRUE(refused([](asset::Exits& e) { e.vertices.texel_weight[4] = 1; }));
  EXPECT_TRUE(refused([](asset::Exits& e) { e.vertices.normal.pop_back(); }));
  EXPECT_TRUE(refused([](asset::Exits& e) { e.vertices.texel_weight.pop_back(); }));
  const auto as_probes = [](asset::Exits& e) {
    e.kind = asset::Exits::Kind::kProbes, e.probes = grid();
    for (std::uint32_t& p : e.probes.probe) p %= 11;  // 99 rows
  };
  EXPECT_FALSE(refused(as_probes));
  EXPECT_TRUE(refused([&](asset::Exits& e) { as_probes(e), e.probes.probe[3] = 11; }));
  EXPECT_TRUE(refused([&](asset::Exits& e) { as_probes(e), e.probes.probe.pop_back(); }));
  EXPECT_TRUE(refused([&](asset::Exits& e) { as_probes(e), e.probes.spacing = 0; }));
  EXPECT_TRUE(refused([&](asset::Exits& e) { as_probes(e), e.probes.count = {1u << 31, 1u << 31, 4}; }));
}

}  // namespace
}  // namespace relume::relight
