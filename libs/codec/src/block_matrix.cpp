// SPDX-License-Identifier: MIT
#include "relume/codec/block_matrix.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "relume/core/check.h"
#include "relume/core/error.h"

namespace relume::codec {
namespace {

[[noreturn]] void corrupt(const std::string& problem) {
  throw Error(ErrorCode::kCorruptAsset, "transfer", problem, "the file was damaged; bake it again");
}

// Offsets [parts + 1] into `size` items.
void checkOffsets(const std::vector<std::uint32_t>& first, std::size_t size, const char* what) {
  if (first.empty() || first.front() != 0 || first.back() != size)
    corrupt(fmt::format("the offsets of its {} do not cover {} of them", what, size));
  if (!std::is_sorted(first.begin(), first.end())) corrupt(fmt::format("the offsets of its {} fall", what));
}

void checkTiles(const BlockMatrix& m) {
  checkOffsets(m.tile_first, m.tile_row.size(), "tiles");
  if (m.rows > m.tile_row.size())
    corrupt(fmt::format("its tiles hold {} rows of {}", m.tile_row.size(), m.rows));
  std::vector<bool> covered(m.rows);
  for (std::size_t t = 0; t < m.tiles(); ++t) {
    for (std::size_t i = m.tile_first[t]; i < m.tile_first[t + 1]; ++i) {
      const std::uint32_t row = m.tile_row[i];
      if (row >= m.rows) corrupt(fmt::format("tile {} has row {} of {}", t, row, m.rows));
      if (i > m.tile_first[t] && row <= m.tile_row[i - 1])
        corrupt(fmt::format("the rows of tile {} do not rise", t));
      covered[row] = true;
    }
  }
  const auto bare = std::find(covered.begin(), covered.end(), false);
  if (bare != covered.end()) corrupt(fmt::format("row {} is in no tile", bare - covered.begin()));
}

void checkClusters(const BlockMatrix& m) {
  checkOffsets(m.cluster_first, m.columns, "clusters");
  if (m.cluster_column.size() != m.columns)
    corrupt(fmt::format("{} columns are in clusters, of {}", m.cluster_column.size(), m.columns));
  std::vector<bool> taken(m.columns);
  for (const std::uint32_t column : m.cluster_column) {
    if (column >= m.columns || taken[column])
      corrupt(fmt::format("its clusters hold column {} twice, or it is none of {}", column, m.columns));
    taken[column] = true;
  }
}

template <class Q>
void checkSamples(const BlockMatrix& m, const std::vector<Q>& planes, const std::vector<Q>& weights) {
  // Sums never pass the sizes of arrays that are there, so they do not overflow.
  std::size_t plane = 0, weight = 0;
  for (std::size_t t = 0; t < m.tiles(); ++t) {
    const std::size_t height = std::size_t{m.channels} * (m.tile_first[t + 1] - m.tile_first[t]);
    for (std::size_t c = 0; c < m.clusters(); ++c) {
      const std::size_t b = t * m.clusters() + c;
      const std::size_t count = m.component_first[b + 1] - m.component_first[b];
      const std::size_t width = m.cluster_first[c + 1] - m.cluster_first[c];
      if (count == 0) continue;
      if (height > (planes.size() - plane) / count || width > (weights.size() - weight) / count)
        corrupt(fmt::format("the samples end within block {}", b));
      plane += count * height;
      weight += count * width;
    }
  }
  if (plane != planes.size() || weight != weights.size())
    corrupt(fmt::format("it has {} samples of planes and {} of weights where its blocks take {} and {}",
                        planes.size(), weights.size(), plane, weight));
  const auto below = [](Q q) { return q == std::numeric_limits<Q>::min(); };
  if (std::any_of(planes.begin(), planes.end(), below) || std::any_of(weights.begin(), weights.end(), below))
    corrupt(fmt::format("a sample is {}", std::numeric_limits<Q>::min()));
}

template <class Q>
float weightFrom(Q q) {
  const double w = static_cast<double>(q) / std::numeric_limits<Q>::max();
  return static_cast<float>(w * std::abs(w));
}

template <class Q>
void multiplySamples(const BlockMatrix& m, const Q* plane, const Q* weight, std::span<const float> x,
                     std::vector<double>& y) {
  for (std::size_t t = 0; t < m.tiles(); ++t) {
    const std::size_t rows = m.tile_first[t + 1] - m.tile_first[t];
    const std::uint32_t* row = m.tile_row.data() + m.tile_first[t];
    for (std::size_t c = 0; c < m.clusters(); ++c) {
      const std::size_t columns = m.cluster_first[c + 1] - m.cluster_first[c];
      const std::uint32_t* column = m.cluster_column.data() + m.cluster_first[c];
      const std::size_t b = t * m.clusters() + c;
      for (std::size_t k = m.component_first[b]; k < m.component_first[b + 1]; ++k, weight += columns) {
        for (std::size_t channel = 0; channel < m.channels; ++channel, plane += rows) {
          double a = 0;
          for (std::size_t j = 0; j < columns; ++j)
            a += static_cast<double>(weightOf(weight[j])) * x[column[j] * m.channels + channel];
          a *= m.scale[k];
          for (std::size_t i = 0; i < rows; ++i) y[row[i] * m.channels + channel] += a * plane[i];
        }
      }
    }
  }
}

template <class T>
std::size_t bytesOf(const std::vector<T>& v) {
  return v.size() * sizeof(T);
}

}  // namespace

std::size_t BlockMatrix::bytes() const {
  return bytesOf(tile_first) + bytesOf(tile_row) + bytesOf(cluster_first) + bytesOf(cluster_column) +
         bytesOf(component_first) + bytesOf(scale) + bytesOf(planes8) + bytesOf(planes16) +
         bytesOf(weights8) + bytesOf(weights16);
}

void BlockMatrix::check() const {
  if (channels != 1 && channels != 3) corrupt(fmt::format("it has {} channels, not 1 or 3", channels));
  if (bits != 8 && bits != 16) corrupt(fmt::format("it has {} bits, not 8 or 16", bits));
  checkTiles(*this);
  checkClusters(*this);
  // Not tiles() * clusters() first: both may be large in a damaged file, and the product wrap.
  checkOffsets(component_first, scale.size(), "blocks");
  const std::size_t blocks = component_first.size() - 1;
  if (tiles() == 0 || clusters() == 0 ? blocks != 0 : blocks / tiles() != clusters() || blocks % tiles() != 0)
    corrupt(fmt::format("it has {} blocks for {} tiles and {} clusters", blocks, tiles(), clusters()));
  if (!std::all_of(scale.begin(), scale.end(), [](float s) { return std::isfinite(s); }))
    corrupt("a scale is not finite");
  if (bits == 8) {
    if (!planes16.empty() || !weights16.empty()) corrupt("it has 8 bits and samples of 16");
    checkSamples(*this, planes8, weights8);
  } else {
    if (!planes8.empty() || !weights8.empty()) corrupt("it has 16 bits and samples of 8");
    checkSamples(*this, planes16, weights16);
  }
}

BlockOffsets offsets(const BlockMatrix& m) {
  BlockOffsets out{{0}, {0}};
  for (std::size_t t = 0; t < m.tiles(); ++t) {
    const std::size_t height = std::size_t{m.channels} * (m.tile_first[t + 1] - m.tile_first[t]);
    for (std::size_t c = 0; c < m.clusters(); ++c) {
      const std::size_t b = t * m.clusters() + c;
      const std::size_t count = m.component_first[b + 1] - m.component_first[b];
      out.plane.push_back(out.plane.back() + count * height);
      out.weight.push_back(out.weight.back() + count * (m.cluster_first[c + 1] - m.cluster_first[c]));
    }
  }
  return out;
}

float weightOf(std::int8_t q) { return weightFrom(q); }
float weightOf(std::int16_t q) { return weightFrom(q); }

void multiply(const BlockMatrix& m, std::span<const float> x, std::span<float> y) {
  RELUME_CHECK_EQ(x.size(), std::size_t{m.columns} * m.channels);
  RELUME_CHECK_EQ(y.size(), std::size_t{m.rows} * m.channels);
  std::vector<double> sum(y.size());
  if (m.bits == 8)
    multiplySamples(m, m.planes8.data(), m.weights8.data(), x, sum);
  else
    multiplySamples(m, m.planes16.data(), m.weights16.data(), x, sum);
  std::transform(sum.begin(), sum.end(), y.begin(), [](double v) { return static_cast<float>(v); });
}

}  // namespace relume::codec
