// SPDX-License-Identifier: MIT
// The stored transfer times irradiance of entries, on the device: tiles and clustered PCA alike, 8 and 16
// bits, one channel and three (codec/block_matrix.h).
#pragma once
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "entry_pass.h"
#include "gl_objects.h"
#include "relume/codec/block_matrix.h"
#include "relume/core/quantity.h"

namespace relume::render {

class ProductPass {
 public:
  /// Throws Error kUnsupported where the device cannot hold its samples in one buffer, kOutOfMemory.
  explicit ProductPass(const codec::BlockMatrix& m);

  /// The place of each column; shape: [columns]
  const std::vector<std::uint32_t>& columns() const { return place_; }
  /// What is multiplied, by place; written before multiply().
  const Buffer& x() const { return x_; }
  void write(std::span<const Irradiance> x);  ///< the same from memory, by column
  void multiply();
  /// shape: [rows] of vec4
  const Buffer& exits() const { return exits_; }
  std::vector<Irradiance> readExits() const;  ///< waits for the device
  std::size_t sampleBytes() const { return planes_.bytes() + weights_.bytes(); }

 private:
  template <class Q>
  void placeSamples(const codec::BlockMatrix& m, const std::vector<Q>& planes, const std::vector<Q>& weights);

  std::uint32_t rows_, clusters_, components_, chunks_ = 0, words_;
  std::vector<std::uint32_t> place_;  // of a column
  Program lit_program_, weights_program_, planes_program_, gather_program_;
  Buffer x_, clusters_buffer_, lit_, component_, cluster_of_, weights_, coefficients_, chunks_buffer_,
      planes_, block_first_, tile_rows_, first_, from_, exits_;
};

}  // namespace relume::render
