// SPDX-License-Identifier: MIT
// y = M x for a BlockMatrix, at the speed at which memory gives its bytes.
//
// In each tile of rows first s[k] = scale[k] sum over columns of weight[k][column] x[column], then y += s[k]
// plane[k]. The second step, which reads most bytes, works in whole numbers: factors s are rounded to 16 bits
// of the largest of 256 of them, which adds at most 1/256 to the rounding error that 8-bit planes have
// already (and is the rounding error of 16-bit planes); four planes are interleaved, so that one instruction
// multiplies and adds all four. Planes of 16 bits are taken as two of 8: q = 257 high + low.
//
// What a tile needs lies together, weights before planes, and one tile after the other: while one is worked
// on, the next one is fetched, since weights keep the processor busy and planes keep the memory busy.
//
// Results do not depend on the number of threads nor on the processor (product_kernels.h). Clusters of
// columns that are all 0 are left out, which changes no bit.
#pragma once
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "line_buffer.h"
#include "product_kernels.h"
#include "relume/codec/block_matrix.h"
#include "relume/core/quantity.h"

namespace relume::relight {

class BlockProduct {
 public:
  static constexpr float kLargest = 1e20f;  ///< of |x|

  /// Copies the matrix into the order in which it is read. `m` has passed check(); throws Error kCorruptAsset
  /// where products could leave the range of floats.
  explicit BlockProduct(const codec::BlockMatrix& m, const ProductKernels& kernels = *kernelsHere().front());

  std::size_t rows() const { return rows_; }
  std::size_t columns() const { return column_place_.size(); }
  /// Stored samples that a product with all columns lit reads, bytes; what pads them is not counted.
  std::size_t sampleBytes() const { return sample_bytes_; }

  /// x: [columns], each |x| <= kLargest; y: [rows]. A matrix of one channel serves all three. Allocates
  /// nothing.
  void multiply(std::span<const Irradiance> x, std::span<Irradiance> y);

 private:
  struct Range {
    std::size_t begin, end;
  };
  struct Cluster {
    std::size_t first, columns;  ///< in x_, whole lanes
    bool dark;
  };
  /// Of one tile and one cluster.
  struct Block {
    Range components;     ///< in sum_
    std::size_t weights;  ///< first byte in stream_
  };
  struct Tile {
    std::size_t rows;     ///< first in target_
    std::size_t held;     ///< rows
    std::size_t sole;     ///< of them those that no other tile has; they come first
    std::size_t strips;   ///< of kStripRows rows
    Range components;     ///< in sum_
    std::size_t quads;    ///< of planes
    Range lines;          ///< in stream_
    std::size_t planes;   ///< first byte in stream_; shape: [strips][quads][channels][kStripRows][kQuad]
    std::size_t factors;  ///< first in factors_; shape: [quads][3][kQuad]
    std::size_t steps;    ///< first in steps_ and starts_; shape: [groups of quads][3]
    std::size_t blocks;   ///< first in blocks_, one for each cluster
    std::size_t lit, lit_count;  ///< ranges in lit_
  };

  void placeColumns(const codec::BlockMatrix& m);
  std::vector<std::uint32_t> placeRows(const codec::BlockMatrix& m);
  void placeBlocks(const codec::BlockMatrix& m);
  template <class Q>
  void copySamples(const codec::BlockMatrix& m, std::span<const std::uint32_t> places,
                   const std::vector<Q>& planes, const std::vector<Q>& weights);

  std::byte* stream() { return stream_.data(); }
  const std::byte* stream() const { return stream_.data(); }
  /// What is fetched while `tile` is worked on.
  Ahead after(const Tile& tile) const;
  void gather(std::span<const Irradiance> x);
  void weigh(const Tile& tile, std::size_t cluster, Ahead& ahead);
  void chooseFactors(Tile& tile);
  void chooseRanges(Tile& tile);
  void addStrips(const Tile& tile, std::size_t first, std::size_t last, std::span<Irradiance> y, Ahead ahead);

  const ProductKernels& kernels_;
  std::size_t rows_ = 0, channels_ = 1, digits_ = 1, sample_bytes_ = 0;
  std::vector<std::uint32_t> column_place_;  ///< of column j in x_
  std::size_t x_stride_ = 0;
  std::vector<float> x_;  ///< [3][x_stride_]
  std::vector<Cluster> clusters_;
  std::vector<Tile> tiles_;
  std::vector<Block> blocks_;
  /// Of each tile the weights, as kernels read them, of cluster after cluster, and the planes.
  LineBuffer stream_;
  std::vector<float> scale_;           ///< by component
  std::vector<float> sum_;             ///< s; shape: [3][components]
  std::vector<std::int16_t> factors_;  ///< s in units of its step
  std::vector<float> steps_;
  std::vector<std::int32_t> starts_;  ///< what takes kPlaneZero out of sums of planes
  std::vector<QuadRange> lit_;        ///< quads of clusters that are not dark, cut where groups end
  /// Of each row of each tile, padded to whole strips: the row of y where no other tile has it, else a place
  /// in shared_.
  std::vector<std::uint32_t> target_;
  std::vector<Irradiance> shared_;
  std::vector<std::uint32_t> shared_row_, shared_first_;  ///< rows of several tiles, and their places
};

}  // namespace relume::relight
