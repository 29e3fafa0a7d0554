// SPDX-License-Identifier: MIT
#include "tile_rows.h"

#include "relume/core/check.h"

namespace relume::codec {

using Eigen::Index;

Matrix tileRows(const Transfer& transfer, std::size_t tile) {
  const WorkItem item("tile", tile);
  const std::size_t rows = transfer.tiles.rows(tile), channels = transfer.channels,
                    columns = transfer.columns;
  std::vector<float> raw(rows * channels * columns);
  transfer.source(tile, raw);
  Matrix out(signedSize(channels * rows), signedSize(columns));
  for (std::size_t r = 0; r < rows; ++r)
    for (std::size_t c = 0; c < channels; ++c)
      std::copy_n(&raw[(r * channels + c) * columns], columns, out.row(signedSize(c * rows + r)).data());
  return out;
}

Eigen::VectorXf tileBlend(const Transfer& transfer, std::size_t tile) {
  const std::size_t rows = transfer.tiles.rows(tile);
  const Eigen::Map<const Eigen::VectorXf> blend(&transfer.tiles.blend[transfer.tiles.first[tile]],
                                                signedSize(rows));
  return blend.replicate(transfer.channels, 1);
}

Matrix columnsOf(const Eigen::Ref<const Matrix>& m, const ColumnClusters& clusters, std::size_t cluster) {
  Matrix out(m.rows(), signedSize(clusters.columns(cluster)));
  for (Index r = 0; r < out.rows(); ++r)
    for (Index j = 0; j < out.cols(); ++j)
      out(r, j) = m(r, clusters.column[clusters.first[cluster] + static_cast<std::size_t>(j)]);
  return out;
}

std::vector<float> addTiles(const Transfer& transfer, const std::vector<Matrix>& of_tile) {
  const std::size_t channels = transfer.channels;
  const std::size_t n = of_tile.empty() ? 0 : static_cast<std::size_t>(of_tile[0].cols());
  std::vector<float> out(n * transfer.rows * channels);
  for (std::size_t t = 0; t < of_tile.size(); ++t) {
    const std::size_t rows = transfer.tiles.rows(t);
    for (std::size_t i = 0; i < rows; ++i)
      for (std::size_t c = 0; c < channels; ++c) {
        const std::size_t at = transfer.tiles.row[transfer.tiles.first[t] + i] * channels + c;
        for (std::size_t l = 0; l < n; ++l)
          out[l * transfer.rows * channels + at] += of_tile[t](signedSize(c * rows + i), signedSize(l));
      }
  }
  return out;
}

}  // namespace relume::codec
