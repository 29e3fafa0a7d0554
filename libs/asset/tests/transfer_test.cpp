// SPDX-License-Identifier: MIT
#include "relume/asset/transfer.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "made_transfer.h"
#include "relume/core/error.h"

namespace relume::asset {
namespace {

Layer layerOf(const Transfer& transfer, const AtlasTable& atlas) {
  Layer layer;
  layer.name = layer.kind = "lightpath";
  layer.tables = transferTables(transfer, atlas);
  return layer;
}

Asset assetOf(const Transfer& transfer, const AtlasTable& atlas) {
  Asset asset;
  asset.atlas = atlas;
  asset.layers = {layerOf(transfer, atlas)};
  return asset;
}

bool sameMatrix(const codec::BlockMatrix& a, const codec::BlockMatrix& b) {
  return a.rows == b.rows && a.columns == b.columns && a.channels == b.channels && a.bits == b.bits &&
         a.tile_first == b.tile_first && a.tile_row == b.tile_row && a.cluster_first == b.cluster_first &&
         a.cluster_column == b.cluster_column && a.component_first == b.component_first &&
         a.scale == b.scale && a.planes8 == b.planes8 && a.planes16 == b.planes16 &&
         a.weights8 == b.weights8 && a.weights16 == b.weights16;
}

TEST(Transfer, RoundTripThroughAFile) {
  const AtlasTable atlas = madeAtlas();
  for (const std::uint32_t bits : {8u, 16u}) {
    Transfer t = madeTransfer(atlas, bits);
    if (bits == 16) mixEntries(t.entries);
    const Asset got = decode(encodeGlb(assetOf(t, atlas)), "test.glb");
    const Transfer back = readTransfer(got.layer("lightpath"), got.atlas);
    EXPECT_TRUE(sameMatrix(back.matrix, t.matrix));
    EXPECT_EQ(back.exits.side, t.exits.side);
    EXPECT_EQ(back.exits.exit_of_texel, t.exits.exit_of_texel);
    EXPECT_EQ(back.entries.samples, t.entries.samples);
    EXPECT_EQ(back.entries.area, t.entries.area);
    EXPECT_EQ(back.entries.first, t.entries.first);
    ASSERT_EQ(back.entries.mix.size(), t.entries.mix.size());
    for (std::size_t i = 0; i < t.entries.mix.size(); ++i)  // 8 bits of the largest of an entry
      EXPECT_NEAR(back.entries.mix[i], t.entries.mix[i], bits == 8 ? 0 : 3.0f / 254);
    ASSERT_EQ(back.entries.position.size(), t.entries.position.size());
    for (std::size_t i = 0; i < t.entries.position.size(); ++i) {
      // 2^-12 of the mean entry's side, of about 1 m
      EXPECT_LT(glm::length(back.entries.position[i] - t.entries.position[i]), 2 * 0x1p-12f);
      EXPECT_LT(glm::length(back.entries.normal[i] - t.entries.normal[i]), 1e-4f);
    }
    // What was read is representable: a second generation loses nothing.
    const Transfer again = readTransfer(layerOf(back, atlas), atlas);
    EXPECT_EQ(again.entries.position, back.entries.position);
    EXPECT_EQ(again.entries.normal, back.entries.normal);
    EXPECT_EQ(again.entries.mix, back.entries.mix);
  }
}

TEST(Transfer, LayersWithoutOneAreAMismatch) {
  try {
    readTransfer(Layer{.name = "ao"}, madeAtlas());
    FAIL();
  } catch (const Error& e) {
    EXPECT_EQ(e.code(), ErrorCode::kMismatch);
    EXPECT_EQ(e.subject(), "layer ao");
  }
}

// Every table missing, of another type, of other channels, cut at every length, one longer: an Error that
// names the layer.
TEST(Transfer, EveryTableMissingOrOfTheWrongShapeIsRefused) {
  const AtlasTable atlas = madeAtlas();
  Transfer t = madeTransfer(atlas);
  mixEntries(t.entries);
  const Layer sound = layerOf(t, atlas);
  const auto refused = [&](const Layer& layer) {
    try {
      readTransfer(layer, atlas);
      return false;
    } catch (const Error& e) {
      EXPECT_EQ(e.subject(), "layer lightpath");
      return e.code() == ErrorCode::kCorruptAsset || e.code() == ErrorCode::kMismatch;
    }
  };
  EXPECT_FALSE(refused(sound));
  for (std::size_t k = 0; k < sound.tables.size(); ++k) {
    SCOPED_TRACE(sound.tables[k].name);
    Layer layer = sound;
    layer.tables.erase(layer.tables.begin() + static_cast<std::ptrdiff_t>(k));
    EXPECT_TRUE(refused(layer));
    layer = sound;
    layer.tables[k].channels += 1;
    EXPECT_TRUE(refused(layer));
    layer = sound;
    layer.tables[k].values = std::vector<std::uint8_t>(16, 0);
    EXPECT_TRUE(refused(layer));
    std::visit(
        [&](const auto& values) {
          for (std::size_t size = 0; size <= values.size() + 1; ++size) {
            if (size == values.size()) continue;
            Layer cut = sound;
            auto other = values;
            other.resize(size);
            cut.tables[k].values = other;
            EXPECT_TRUE(refused(cut)) << size;
          }
        },
        sound.tables[k].values);
  }
}

TEST(Transfer, NumbersThatMakeNoSenseAreRefused) {
  const AtlasTable atlas = madeAtlas();
  const auto refused = [&](const std::function<void(Transfer&)>& change) {
    Transfer t = madeTransfer(atlas);
    mixEntries(t.entries);
    change(t);
    try {
      t.check(atlas, "lightpath");
      return false;
    } catch (const Error& e) {
      return e.code() == ErrorCode::kCorruptAsset;
    }
  };
  const float nan = std::nanf("");
  EXPECT_FALSE(refused([](Transfer&) {}));
  EXPECT_TRUE(refused([](Transfer& t) { t.exits.exit_of_texel[3] = 18; }));
  EXPECT_TRUE(refused([](Transfer& t) { t.exits.exit_of_texel[3] = 17; }));  // of another block
  EXPECT_TRUE(refused([](Transfer& t) { t.exits.side = 0; }));
  EXPECT_TRUE(refused([](Transfer& t) { t.exits.side = 3; }));
  EXPECT_TRUE(refused([](Transfer& t) { t.entries.samples = 0; }));
  EXPECT_TRUE(refused([](Transfer& t) { t.entries.samples = 0x80000001u; }));
  EXPECT_TRUE(refused([&](Transfer& t) { t.entries.position[1].y = nan; }));
  EXPECT_TRUE(refused([](Transfer& t) { t.entries.normal[1] *= 1.1f; }));
  EXPECT_TRUE(refused([&](Transfer& t) { t.entries.normal[1].x = nan; }));
  EXPECT_TRUE(refused([](Transfer& t) { t.entries.area[1] = -1; }));
  EXPECT_TRUE(refused([&](Transfer& t) { t.entries.area[1] = nan; }));
  EXPECT_TRUE(refused([](Transfer& t) { t.entries.mix[1] = kInfinity; }));
  EXPECT_TRUE(refused([](Transfer& t) { t.entries.mix.pop_back(); }));
  EXPECT_TRUE(refused([](Transfer& t) { t.entries.first[1] = 3; }));  // a patch of none
  EXPECT_TRUE(refused([](Transfer& t) { t.entries.first[3] = 6; }));
  EXPECT_TRUE(refused([](Transfer& t) { t.entries.first[0] = 1; }));
  EXPECT_TRUE(refused([](Transfer& t) { t.entries.first.clear(); }));
  EXPECT_TRUE(refused([](Transfer& t) { t.matrix.tile_row[2] = 18; }));
  EXPECT_TRUE(refused([](Transfer& t) { t.matrix.cluster_column[2] = 5; }));
  EXPECT_TRUE(refused([&](Transfer& t) { t.matrix.scale[2] = nan; }));
  EXPECT_TRUE(refused([](Transfer& t) { t.matrix.channels = 2; }));
}

}  // namespace
}  // namespace relume::asset
