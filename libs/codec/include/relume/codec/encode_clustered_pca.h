// SPDX-License-Identifier: MIT
// Transfer by clustered principal component analysis: in each cluster of columns, the mean of its columns and
// the directions in which they differ most, each a plane over all rows. The form of the paper; tiles
// (encode_tiles.h) take a tenth of the bytes for the same error. Based on:
//   [Umenhoffer] Umenhoffer, Szirmay-Kalos, Szecsi, Toth. Global Illumination in Games with Multi-scale PRT,
//   section 7.3.
//   [Sloan03] Sloan, Hall, Hart, Snyder. Clustered Principal Components for Precomputed Radiance Transfer.
//   2003.
#pragma once
#include "relume/codec/encode.h"
#include "relume/core/progress.h"

namespace relume::codec {

struct ClusteredPcaOptions {
  std::size_t rank =
      8;  ///< planes of each cluster beside the mean, where error is 0; at most so many elsewhere
  /// Bound of EncodeError::mean on the held-out lights; each cluster then gets the planes whose variance is
  /// above a threshold common to all. 0: `rank` planes each.
  double error = 0;
  std::uint32_t bits = 8;
};

struct EncodedClusteredPca {
  BlockMatrix matrix;   ///< one tile with all rows
  EncodeReport report;  ///< errors where there are held-out lights
  /// Squared Frobenius error with D exact planes in each cluster, for D = 0 up to its number of columns less
  /// one: the sum of the variances left out, which no other D planes beside the mean can do better than.
  /// shape: [clusters][D]
  std::vector<std::vector<double>> optimal_error;
};

/// Reads every tile twice: for the scatter matrices, columns of a cluster squared each, and for the planes.
/// Tiles are only how rows are read, their blend is not used. Keeps the planes as floats meanwhile, four
/// times (8 bits) the result. Deterministic, whatever the number of threads. Throws Error kInterrupted when
/// `progress` is cancelled.
EncodedClusteredPca encodeClusteredPca(const Transfer& transfer, const ColumnClusters& clusters,
                                       const Lights& lights, const ClusteredPcaOptions& options = {},
                                       Progress* progress = nullptr);

}  // namespace relume::codec
