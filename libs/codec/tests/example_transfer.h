// SPDX-License-Identifier: MIT
// A Transfer over a matrix in memory, with tiles and clusters by k-means.
#pragma once
#include <algorithm>
#include <cmath>
#include <cstring>
#include <utility>
#include <vector>

#include "relume/codec/encode.h"
#include "relume/core/kmeans.h"
#include "two_rooms.h"

namespace relume::codec::test {

inline std::vector<float> features(const std::vector<Vec3>& position, const std::vector<Vec3>& normal,
                                   float length) {
  std::vector<float> out;
  for (std::size_t i = 0; i < position.size(); ++i)
    for (const Vec3 v : {position[i], length * normal[i]}) out.insert(out.end(), {v.x, v.y, v.z});
  return out;
}

/// Tiles of about `size` points that lie together. A point is in all tiles whose centre is at most `band`
/// tile sides farther than the nearest; what it takes from each falls linearly to nothing.
inline RowTiles overlappingTiles(const std::vector<Vec3>& position, const std::vector<Vec3>& normal,
                                 float area, std::size_t size, float band) {
  const std::size_t count = (position.size() + size - 1) / size;
  const float side = std::sqrt(area / static_cast<float>(count));
  const std::vector<float> f = features(position, normal, side);
  const KMeans k = kMeans(f, 6, {}, {.clusters = count});
  std::vector<std::vector<std::pair<std::uint32_t, float>>> members(count);
  for (std::size_t i = 0; i < position.size(); ++i) {
    std::vector<float> distance(count);
    for (std::size_t t = 0; t < count; ++t) {
      for (std::size_t d = 0; d < 6; ++d) distance[t] += std::pow(f[6 * i + d] - k.centre[6 * t + d], 2.0f);
      distance[t] = std::sqrt(distance[t]);
    }
    const float nearest = distance[k.label[i]];
    std::vector<float> blend(count);
    float sum = 0;
    for (std::size_t t = 0; t < count; ++t) {
      blend[t] = band > 0          ? std::max(0.0f, 1 - (distance[t] - nearest) / (band * side))
                 : t == k.label[i] ? 1.0f
                                   : 0.0f;
      sum += blend[t];
    }
    for (std::size_t t = 0; t < count; ++t)
      if (blend[t] > 0) members[t].push_back({static_cast<std::uint32_t>(i), blend[t] / sum});
  }
  RowTiles out{{0}, {}, {}};
  for (const auto& tile : members) {
    for (const auto& [row, blend] : tile) {
      out.row.push_back(row);
      out.blend.push_back(blend);
    }
    out.first.push_back(static_cast<std::uint32_t>(out.row.size()));
  }
  return out;
}

/// `matrix`: [rows][channels][columns], which must outlive what is returned.
inline Transfer transferOf(const std::vector<float>& matrix, std::uint32_t columns, std::uint32_t channels,
                           RowTiles tiles) {
  Transfer out{.rows = static_cast<std::uint32_t>(matrix.size() / channels / columns),
               .columns = columns,
               .channels = channels,
               .tiles = std::move(tiles)};
  const std::size_t row = std::size_t{channels} * columns;
  std::vector<std::uint32_t> first = out.tiles.first, rows = out.tiles.row;
  out.source = [&matrix, row, first, rows](std::size_t tile, std::span<float> to) {
    for (std::size_t i = first[tile]; i < first[tile + 1]; ++i)
      std::memcpy(&to[(i - first[tile]) * row], &matrix[rows[i] * row], row * sizeof(float));
  };
  return out;
}

inline ColumnClusters clustersOf(const TwoRooms& rooms, std::size_t count) {
  return clustersFromLabels(
      kMeans(features(rooms.entry_position, rooms.entry_normal, 1), 6, {}, {.clusters = count}).label, count);
}

inline constexpr float kTwoRoomsArea = 408;  // about

}  // namespace relume::codec::test
