// SPDX-License-Identifier: MIT
// Transfers of random numbers, of any size, and bakes that carry them, for tests and benchmarks.
#pragma once
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <random>
#include <vector>

#include "relume/asset/transfer.h"

namespace relume::relight {

struct MadeMatrix {
  std::uint32_t rows = 100, columns = 40, channels = 3, bits = 8;
  std::uint32_t tiles = 3, clusters = 2;
  std::uint32_t rank = 5;     ///< most components of a block; one block has none
  std::uint32_t overlap = 8;  ///< rows that a tile shares with the next
  bool exact_rank = false;    ///< every block has `rank`
};

inline codec::BlockMatrix madeMatrix(const MadeMatrix& want, std::uint32_t seed = 1) {
  std::mt19937 random(seed);
  codec::BlockMatrix m;
  m.rows = want.rows, m.columns = want.columns, m.channels = want.channels, m.bits = want.bits;
  m.tile_first = {0};
  for (std::uint32_t t = 0; t < want.tiles; ++t) {
    const auto at = [&](std::uint32_t i) {
      return static_cast<std::uint32_t>(std::uint64_t{want.rows} * i / want.tiles);
    };
    for (std::uint32_t row = at(t); row < std::min(want.rows, at(t + 1) + want.overlap); ++row)
      m.tile_row.push_back(row);
    m.tile_first.push_back(static_cast<std::uint32_t>(m.tile_row.size()));
  }
  m.cluster_column.resize(want.columns);
  std::iota(m.cluster_column.begin(), m.cluster_column.end(), 0u);
  std::shuffle(m.cluster_column.begin(), m.cluster_column.end(), random);
  for (std::uint32_t c = 0; c <= want.clusters; ++c)
    m.cluster_first.push_back(static_cast<std::uint32_t>(std::uint64_t{want.columns} * c / want.clusters));
  m.component_first = {0};
  std::size_t planes = 0, weights = 0;
  for (std::uint32_t b = 0; b < want.tiles * want.clusters; ++b) {
    std::uint32_t count = want.exact_rank ? want.rank : b == 1 ? 0 : 1 + random() % want.rank;
    m.component_first.push_back(m.component_first.back() + count);
    const std::uint32_t t = b / want.clusters, c = b % want.clusters;
    planes += std::size_t{count} * want.channels * (m.tile_first[t + 1] - m.tile_first[t]);
    weights += std::size_t{count} * (m.cluster_first[c + 1] - m.cluster_first[c]);
  }
  const int most = want.bits == 8 ? 127 : 32767;
  const auto fill = [&](auto& samples, std::size_t count) {
    samples.resize(count);
    for (auto& q : samples)
      q = static_cast<std::remove_reference_t<decltype(q)>>(
          static_cast<int>(random() % static_cast<unsigned>(2 * most + 1)) - most);
  };
  if (want.bits == 8)
    fill(m.planes8, planes), fill(m.weights8, weights);
  else
    fill(m.planes16, planes), fill(m.weights16, weights);
  std::uniform_real_distribution<float> unit;
  for (std::uint32_t k = 0; k < m.component_first.back(); ++k)
    m.scale.push_back(std::pow(0.5f, 6 * unit(random)) / static_cast<float>(most));
  return m;
}

/// Patches of so many entries each.
inline void mixEntries(asset::Entries& entries, std::uint32_t each, std::mt19937& random) {
  std::uniform_real_distribution<float> mix(-0.5f, 0.5f);
  entries.first.clear();
  for (std::uint32_t e = 0; e <= entries.size(); e += each) entries.first.push_back(e);
  for (float& m : entries.mix) m = mix(random);
  for (std::size_t i = 0; i < entries.mix.size(); i += each)  // the mean
    entries.mix[i] = 1.0f / static_cast<float>(entries.samples);
}

/// Atlas and transfer whose exits are blocks of side x side texels, row after row over one page of two charts
/// (left and right half) with some holes; entries random in a room of 4 x 3 x 5 m, `patch_entries` to
/// a patch: a mean and modes.
inline asset::Asset madeBake(MadeMatrix want, std::uint32_t side = 4, std::uint32_t samples = 3,
                             std::uint32_t patch_entries = 1) {
  asset::Asset bake;
  asset::AtlasTable& atlas = bake.atlas;
  const std::uint32_t blocks_x = 10, blocks_y = (want.rows + blocks_x - 1) / blocks_x;
  const std::uint32_t width = blocks_x * side, height = blocks_y * side;
  atlas.width = static_cast<int>(width), atlas.height = static_cast<int>(height), atlas.pages = 1;
  asset::Transfer t;
  t.exits.side = side;
  for (std::uint32_t texel = 0; texel < width * height; ++texel) {
    const std::uint32_t x = texel % width, y = texel / width, exit = y / side * blocks_x + x / side;
    if (exit >= want.rows || (side > 1 && x % 7 == 3 && y % 5 == 1)) continue;
    atlas.texel.push_back(texel);
    atlas.position.push_back(0.1f * Point(x, 0, y));
    atlas.normal.push_back({0, 1, 0});
    atlas.valid.push_back(1);
    atlas.chart.push_back(x < width / 2 ? 0 : 1);
    t.exits.exit_of_texel.push_back(exit);
  }
  t.matrix = madeMatrix(want);
  std::mt19937 random(5);
  std::uniform_real_distribution<float> unit;
  t.entries.samples = samples;
  for (std::uint32_t i = 0; i < want.columns / patch_entries * samples; ++i) {
    t.entries.position.push_back(Vec3(4, 3, 5) * Vec3(unit(random), unit(random), unit(random)));
    t.entries.normal.push_back(
        glm::normalize(Vec3(unit(random) - 0.5f, 0.1f + unit(random), unit(random) - 0.5f)));
  }
  for (std::uint32_t e = 0; e < want.columns; ++e) t.entries.area.push_back(0.5f + unit(random));
  t.entries.setMeans(want.columns);
  if (patch_entries > 1) mixEntries(t.entries, patch_entries, random);
  asset::Layer layer;
  layer.name = layer.kind = "lightpath";
  layer.tables = asset::transferTables(t, atlas);
  bake.layers = {layer};
  return bake;
}

}  // namespace relume::relight
