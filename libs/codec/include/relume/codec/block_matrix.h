// SPDX-License-Identifier: MIT
// A large matrix, such as the transfer from entry points of light to receivers, as low-rank blocks of few
// bits: what the encoders of transfer make, files store and the run time multiplies.
#pragma once
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace relume::codec {

/// y[row][channel] = sum over columns of M[row][channel][column] x[column][channel], where M is the sum of
/// one low-rank block for each (tile of rows, cluster of columns):
///
///   M[row][channel][column] = sum over tiles t that hold row, with c the cluster that holds column, sum over
///   components
///     k of block (t, c): scale[k] * plane[k][channel][row] * weight[k][column],
///   weight = sign(q) (q / max)^2, plane = q, max = 127 for 8 bits, 32767 for 16.
///
/// Weights are shared by the channels. Tiles may overlap: what each gives is already multiplied by its share
/// of the row. Clusters part the columns. Clustered PCA is the case of one tile that holds all rows: in each
/// cluster a mean plane, whose weights are all 1, then the eigenplanes.
struct BlockMatrix {
  std::uint32_t rows = 0, columns = 0;
  std::uint32_t channels = 1;                 ///< 1 or 3
  std::uint32_t bits = 8;                     ///< 8 or 16, of planes and weights alike
  std::vector<std::uint32_t> tile_first;      ///< shape: [tiles + 1], into tile_row
  std::vector<std::uint32_t> tile_row;        ///< rows of each tile, rising within it
  std::vector<std::uint32_t> cluster_first;   ///< shape: [clusters + 1], into cluster_column
  std::vector<std::uint32_t> cluster_column;  ///< a permutation of the columns
  /// Components of block (t, c) are component_first[t * clusters + c] up to the next; shape: [tiles *
  /// clusters + 1]
  std::vector<std::uint32_t> component_first;
  std::vector<float> scale;  ///< shape: [components]
  /// One of the two, by `bits`, each in [-max, max]; of each component in turn, shape: [channels][rows of its
  /// tile]
  std::vector<std::int8_t> planes8;
  std::vector<std::int16_t> planes16;
  /// One of the two, by `bits`, each in [-max, max]; of each component in turn, shape: [columns of its
  /// cluster], in the order of cluster_column
  std::vector<std::int8_t> weights8;
  std::vector<std::int16_t> weights16;

  std::size_t tiles() const { return tile_first.size() - 1; }
  std::size_t clusters() const { return cluster_first.size() - 1; }
  std::size_t components() const { return scale.size(); }
  /// Memory of all arrays.
  std::size_t bytes() const;

  /// Throws Error kCorruptAsset unless the arrays fit each other, every index is in range, every row is in
  /// some tile and every column in one cluster, scales are finite and samples within [-max, max].
  void check() const;
};

/// Where the samples of a block begin.
struct BlockOffsets {
  std::vector<std::size_t> plane;   ///< shape: [tiles * clusters + 1], into planes8 or planes16
  std::vector<std::size_t> weight;  ///< shape: [tiles * clusters + 1], into weights8 or weights16
};
BlockOffsets offsets(const BlockMatrix& m);

/// The value of a stored weight: sign(q) (q / max)^2.
float weightOf(std::int8_t q);
float weightOf(std::int16_t q);

/// y = M x in double precision, plainly: the reference for faster products. `m` has passed check().
/// x: [columns][channels]; y: [rows][channels]
void multiply(const BlockMatrix& m, std::span<const float> x, std::span<float> y);

}  // namespace relume::codec
