// SPDX-License-Identifier: MIT
// Rows of a tile as a matrix, a row of each channel in turn, and back.
#pragma once
#include <vector>

#include "range.h"
#include "relume/codec/encode.h"

namespace relume::codec {

inline Eigen::Index signedSize(std::size_t n) { return static_cast<Eigen::Index>(n); }

/// Rows of a tile from their source, not blended. shape: [channels * rows of the tile][columns]
Matrix tileRows(const Transfer& transfer, std::size_t tile);
/// Each row's blend, for each channel in turn. shape: [channels * rows of the tile]
Eigen::VectorXf tileBlend(const Transfer& transfer, std::size_t tile);
/// Columns of a cluster. m: [any][columns]; shape: [any][columns of the cluster]
Matrix columnsOf(const Eigen::Ref<const Matrix>& m, const ColumnClusters& clusters, std::size_t cluster);
/// What blended tiles give together, in order of tiles. of_tile: [tiles][channels * rows of the tile][n];
/// returns [n][rows][channels]
std::vector<float> addTiles(const Transfer& transfer, const std::vector<Matrix>& of_tile);

}  // namespace relume::codec
