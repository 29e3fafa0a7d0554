// SPDX-License-Identifier: MIT
#include "light_paths/exit_tiles.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "relume/core/parallel.h"

namespace relume::transport {
namespace {

constexpr float kNormalWeight = 1.0f;  // sides of a tile
constexpr std::size_t kMostTiles = 6;  // of an exit
constexpr int kHalvings = 30;

struct Near {
  std::array<Nearest::Found, kMostTiles> tile;  // squared: farther than the nearest one, metres
  std::size_t count = 0;
  std::size_t within(float band) const {
    std::size_t n = 1;
    while (n < count && tile[n].squared < band) ++n;
    return n;
  }
};

}  // namespace

ExitTiles makeTiles(std::span<const Exit> exits, std::uint32_t each, float overlap, std::uint64_t seed,
                    Progress& progress) {
  // All exits count alike: tiles shall have equal numbers of them.
  float area = 0;
  for (const Exit& e : exits) area += e.area;
  std::vector<Piece> pieces;
  for (const Exit& e : exits)
    pieces.push_back({e.position, e.normal, area / static_cast<float>(exits.size())});
  const std::size_t count = std::max<std::size_t>((exits.size() + each / 2) / each, 1);
  const Clusters clusters =
      makeClusters(pieces, std::vector<float>(pieces.size(), 1.0f), {count, kNormalWeight, seed}, progress);

  const Nearest nearest(clusters.centre);
  std::vector<Near> near(exits.size());
  parallelFor(exits.size(), 1024, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      Near& n = near[i];
      n.count = nearest.find(clusters.feature(exits[i].position, exits[i].normal), n.tile);
      const float first = std::sqrt(n.tile[0].squared);
      for (std::size_t k = 0; k < n.count; ++k) n.tile[k].squared = std::sqrt(n.tile[k].squared) - first;
    }
  });
  // The band that gives the overlap.
  const auto rowsWith = [&](float band) {
    std::size_t rows = 0;
    for (const Near& n : near) rows += n.within(band);
    return rows;
  };
  const auto wanted = static_cast<std::size_t>((1.0f + overlap) * static_cast<float>(exits.size()));
  float lo = 0, hi = clusters.normal_length;
  for (int i = 0; i < kHalvings; ++i) {
    const float middle = 0.5f * (lo + hi);
    (rowsWith(middle) > wanted ? hi : lo) = middle;
  }
  const float band = lo;

  std::vector<std::vector<std::pair<std::uint32_t, float>>> members(clusters.size());
  for (std::uint32_t i = 0; i < near.size(); ++i) {
    const std::size_t n = near[i].within(band);
    float sum = 0;
    std::array<float, kMostTiles> weight;
    for (std::size_t k = 0; k < n; ++k)
      sum += weight[k] = band > 0 ? 1.0f - near[i].tile[k].squared / band : 1.0f;
    for (std::size_t k = 0; k < n; ++k)
      if (weight[k] > 0) members[near[i].tile[k].index].emplace_back(i, weight[k] / sum);
  }
  ExitTiles tiles;
  tiles.first.push_back(0);
  for (const auto& tile : members) {
    if (tile.empty()) continue;
    for (const auto& [exit, blend] : tile) tiles.row.push_back(exit), tiles.blend.push_back(blend);
    tiles.first.push_back(static_cast<std::uint32_t>(tiles.row.size()));
  }
  return tiles;
}

}  // namespace relume::transport
