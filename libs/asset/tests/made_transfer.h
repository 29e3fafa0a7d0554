// SPDX-License-Identifier: MIT
// A small transfer with random numbers over a small atlas, for tests.
#pragma once
#include <cstdint>
#include <random>
#include <vector>

#include "relume/asset/transfer.h"

namespace relume::asset {

/// One page of 24 x 12, two charts (left and right half) of which the right one lacks every third texel.
inline AtlasTable madeAtlas() {
  AtlasTable a;
  a.width = 24, a.height = 12, a.pages = 1;
  for (std::uint32_t t = 0; t < 24 * 12; ++t) {
    const std::uint32_t column = t % 24, row = t / 24;
    if (column >= 12 && (column + row) % 3 == 0) continue;
    a.texel.push_back(t);
    a.position.push_back({0.1f * static_cast<float>(column), 0, 0.1f * static_cast<float>(row)});
    a.normal.push_back({0, 1, 0});
    a.albedo.push_back(Vec3(0.5f));
    a.valid.push_back(1);
    a.chart.push_back(column < 12 ? 0 : 1);
  }
  return a;
}

/// Blocks of 4 x 4 texels; 5 entries of 2 points in 2 clusters; 3 tiles of exits that overlap.
inline Transfer madeTransfer(const AtlasTable& atlas, std::uint32_t bits = 8, std::uint32_t channels = 3) {
  std::mt19937 random(7);
  Transfer t;
  t.exits.side = 4;
  for (const std::uint32_t texel : atlas.texel)
    t.exits.exit_of_texel.push_back(texel / 24 / 4 * 6 + texel % 24 / 4);
  codec::BlockMatrix& m = t.matrix;
  m.rows = 18, m.columns = 5, m.channels = channels, m.bits = bits;
  m.tile_first = {0, 8, 15, 21};
  m.tile_row = {0, 1, 2, 3, 4, 5, 6, 7, 6, 7, 8, 9, 10, 11, 12, 12, 13, 14, 15, 16, 17};
  m.cluster_first = {0, 3, 5};
  m.cluster_column = {4, 0, 2, 1, 3};
  m.component_first = {0, 2, 3, 3, 6, 8, 9};  // block (1, 0) has none
  std::size_t planes = 0, weights = 0;
  for (std::size_t b = 0; b < 6; ++b) {
    const std::size_t count = m.component_first[b + 1] - m.component_first[b];
    planes += count * channels * (m.tile_first[b / 2 + 1] - m.tile_first[b / 2]);
    weights += count * (m.cluster_first[b % 2 + 1] - m.cluster_first[b % 2]);
  }
  const int most = bits == 8 ? 127 : 32767;
  std::uniform_int_distribution<int> sample(-most, most);
  for (std::size_t i = 0; i < planes; ++i)
    bits == 8 ? m.planes8.push_back(static_cast<std::int8_t>(sample(random)))
              : m.planes16.push_back(static_cast<std::int16_t>(sample(random)));
  for (std::size_t i = 0; i < weights; ++i)
    bits == 8 ? m.weights8.push_back(static_cast<std::int8_t>(sample(random)))
              : m.weights16.push_back(static_cast<std::int16_t>(sample(random)));
  std::uniform_real_distribution<float> unit;
  for (int k = 0; k < 9; ++k) m.scale.push_back((0.1f + unit(random)) / static_cast<float>(most));
  t.entries.samples = 2;
  for (int i = 0; i < 10; ++i) {
    t.entries.position.push_back({4 * unit(random), 3 * unit(random), 5 * unit(random)});
    t.entries.normal.push_back(glm::normalize(Vec3(unit(random) - 0.5f, unit(random), unit(random) - 0.5f)));
  }
  for (int i = 0; i < 5; ++i) t.entries.area.push_back(0.5f + unit(random));
  t.entries.setMeans(5);
  return t;
}

/// The same, of 3 patches with 2, 1 and 2 entries.
inline void mixEntries(Entries& entries) {
  entries.first = {0, 2, 3, 5};
  entries.position.resize(6), entries.normal.resize(6);
  entries.mix = {0.5f, -2, 0.5f, 2, 0.25f, 0.75f, 3, 0.01f, 0.25f, -0.02f};
}

}  // namespace relume::asset
