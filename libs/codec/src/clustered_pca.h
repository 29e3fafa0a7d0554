// SPDX-License-Identifier: MIT
// Clustered PCA before rounding.
#pragma once
#include <vector>

#include "relume/codec/encode_clustered_pca.h"
#include "tile_rows.h"

namespace relume::codec {

struct PcaCluster {
  Eigen::VectorXd variance;  // falling; shape: [columns]
  Matrix weights;            // of the mean (all 1) and of each plane; shape: [1 + planes][columns]
  Matrix planes;             // the mean, then orthonormal ones; shape: [1 + planes][channels * rows]
};

/// At most `rank` planes in each cluster beside the mean.
std::vector<PcaCluster> clusteredPca(const Transfer& transfer, const ColumnClusters& clusters,
                                     std::size_t rank, Progress* progress);

}  // namespace relume::codec
