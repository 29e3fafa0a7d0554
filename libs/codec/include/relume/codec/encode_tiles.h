// SPDX-License-Identifier: MIT
// Transfer as low-rank blocks, one for each (tile of rows, cluster of columns), as good as asked for on the
// lights that it will be used with and no better. Transfer is not of low rank as a whole, since every entry
// lights its own neighbourhood, but seen from one tile it nearly is. Based on:
//   [Halko11] Halko, Martinsson, Tropp. Finding Structure with Randomness. SIAM Review 53(2), 2011.
//   [Sloan03] Sloan, Hall, Hart, Snyder. Clustered Principal Components for Precomputed Radiance Transfer.
//   2003.
#pragma once
#include <limits>

#include "relume/codec/encode.h"
#include "relume/core/progress.h"

namespace relume::codec {

struct TileOptions {
  /// Bound of EncodeError::mean; 0: every block gets `rank` components instead.
  double error = 0.02;
  /// Bound of EncodeError::row_p95, for dark rows; 0: none.
  double row_error = 0.3;
  /// What that bound may cost, as a share of the bytes that `error` alone takes: where it would cost more it
  /// is not met. Light that comes to dark rows by few rays is mostly noise, which takes any number of bytes.
  double row_bytes = std::numeric_limits<double>::infinity();
  std::size_t rank = 16;        ///< of every block, where error is 0
  std::size_t most_rank = 128;  ///< of any block
  /// Weight of all columns alike beside that of the training lights. Without it, lights unlike those pay.
  double plain_share = 0.03;
  /// Weight of the error relative to a tile's own light beside that of the error relative to all light.
  double dark_share = 0.5;
  std::uint32_t bits = 8;
};

struct EncodedTiles {
  BlockMatrix matrix;
  EncodeReport report;
};

/// Needs training lights, and held-out lights where there is an error to be bounded. Deterministic, whatever
/// the number of threads. Throws Error kInterrupted when `progress` is cancelled.
EncodedTiles encodeTiles(const Transfer& transfer, const ColumnClusters& clusters, const Lights& lights,
                         const TileOptions& options = {}, Progress* progress = nullptr);

}  // namespace relume::codec
