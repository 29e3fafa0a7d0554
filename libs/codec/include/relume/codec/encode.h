// SPDX-License-Identifier: MIT
// What the encoders of transfer matrices share: where rows come from, how rows and columns are parted, and
// what an encoding cost and lost.
#pragma once
#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "relume/codec/block_matrix.h"

namespace relume::codec {

/// Tiles of rows that lie together. They may overlap; what a tile gives to a row is multiplied by `blend`,
/// which sums to 1 over the tiles of each row, so that no seam shows where one tile's approximation ends.
struct RowTiles {
  std::vector<std::uint32_t> first;  ///< shape: [tiles + 1], into row and blend
  std::vector<std::uint32_t> row;    ///< rising within a tile
  std::vector<float> blend;          ///< in (0, 1]
  std::size_t tiles() const { return first.size() - 1; }
  std::size_t rows(std::size_t tile) const { return first[tile + 1] - first[tile]; }
};

/// Disjoint clusters of columns.
struct ColumnClusters {
  std::vector<std::uint32_t> first;   ///< shape: [clusters + 1], into column
  std::vector<std::uint32_t> column;  ///< a permutation of all columns
  std::size_t clusters() const { return first.size() - 1; }
  std::size_t columns(std::size_t cluster) const { return first[cluster + 1] - first[cluster]; }
};

/// Clusters from one label for each column, in [0, clusters).
ColumnClusters clustersFromLabels(std::span<const std::uint32_t> labels, std::size_t clusters);

/// Writes the rows of a tile as they are, not blended; out: [rows of the tile][channels][columns]. Called for
/// several tiles at a time from several threads, and perhaps for a tile more than once, so that the whole
/// matrix need never be in memory; what it gives must then be the same.
using RowSource = std::function<void(std::size_t tile, std::span<float> out)>;

/// The matrix to be encoded.
struct Transfer {
  std::uint32_t rows = 0, columns = 0;
  std::uint32_t channels = 3;  ///< 1 or 3
  RowTiles tiles;
  RowSource source;
};

/// Vectors that the matrix will be multiplied with, such as irradiance of random lights on the entries. The
/// same for all channels, finite and not negative. Those that are zero everywhere count for nothing.
struct Lights {
  std::vector<float> training;  ///< shape: [n][columns]; the encoder weighs errors by them
  std::vector<float> held_out;  ///< shape: [m][columns]; errors are measured with them
};

/// How far products are off on held-out lights, against the matrix before encoding.
struct EncodeError {
  /// Of ||error|| / ||truth|| of each light, norms over rows and channels.
  double mean = 0, median = 0, worst = 0;
  /// 95th percentile over all rows and lights of the error of a row relative to the row's own truth: what
  /// dark rows show. Rows with less than kRowFloor of a light's root mean square over all rows count as if
  /// they had so much: that light shows nothing there, and they may be many.
  double row_p95 = 0;
};
inline constexpr double kRowFloor = 0.01;

struct EncodeReport {
  EncodeError error;
  bool met = true;        ///< the bounds asked for are met
  std::size_t bytes = 0;  ///< of all arrays of the matrix
  std::size_t plane_bytes = 0, weight_bytes = 0, index_bytes = 0;
  std::size_t row_bytes = 0;  ///< of `bytes`, what the bound of row_p95 took beside that of the mean
  double overlap = 1;         ///< rows in tiles / rows
  /// Share of the squared error, as the encoder weighs it, that is due to rounding; the rest is what the
  /// components left out would have given.
  double rounding_share = 0;
  std::vector<std::size_t> rank_count;  ///< blocks by their number of components
};

/// A report with all that concerns sizes.
EncodeReport sizesOf(const BlockMatrix& m);
/// Errors of `m` on lights x for which `truth` is right. x: [n][columns]; truth: [n][rows][channels]
EncodeError measure(const BlockMatrix& m, std::span<const float> x, std::span<const float> truth);
/// Errors of products. Both: [n][rows][channels]
EncodeError measureProducts(std::span<const float> given, std::span<const float> truth, std::size_t rows,
                            std::size_t channels);
/// Products of the matrix itself. x: [n][columns]; returns [n][rows][channels]
std::vector<float> products(const Transfer& transfer, std::span<const float> x);

}  // namespace relume::codec
