// SPDX-License-Identifier: MIT
#include "relume/codec/encode.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "relume/core/check.h"
#include "relume/core/parallel.h"
#include "tile_rows.h"

namespace relume::codec {
namespace {

// Quantile by the nearest rank; 0 of nothing.
double quantile(std::vector<float>& values, double share) {
  if (values.empty()) return 0;
  const auto n = static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1) + 0.5);
  std::nth_element(values.begin(), values.begin() + n, values.end());
  return values[static_cast<std::size_t>(n)];
}

// All lights at once, by products of matrices. returns [lights][rows][channels]
template <class Q>
std::vector<float> productsOf(const BlockMatrix& m, const std::vector<Q>& planes,
                              const std::vector<Q>& weights, std::span<const float> x, std::size_t lights) {
  using Samples = Eigen::Map<const Eigen::Matrix<Q, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>>;
  const Eigen::Map<const Matrix> all(x.data(), signedSize(lights), signedSize(m.columns));
  const ColumnClusters clusters{m.cluster_first, m.cluster_column};
  const BlockOffsets at = offsets(m);
  const Transfer shape{
      .rows = m.rows, .columns = m.columns, .channels = m.channels, .tiles = {m.tile_first, m.tile_row, {}}};
  std::vector<Matrix> of_tile(m.tiles());
  parallelFor(m.tiles(), 1, [&](std::size_t t, std::size_t) {
    of_tile[t] = Matrix::Zero(signedSize(m.channels * shape.tiles.rows(t)), signedSize(lights));
    for (std::size_t c = 0; c < m.clusters(); ++c) {
      const std::size_t b = t * m.clusters() + c;
      const Eigen::Index rank = m.component_first[b + 1] - m.component_first[b];
      if (rank == 0) continue;
      const Samples plane(planes.data() + at.plane[b], rank, of_tile[t].rows());
      const Samples weight(weights.data() + at.weight[b], rank, signedSize(clusters.columns(c)));
      const Eigen::Map<const Eigen::VectorXf> scale(m.scale.data() + m.component_first[b], rank);
      const Matrix values = weight.unaryExpr([](Q q) { return weightOf(q); });
      const Matrix lit = scale.asDiagonal() * (values * columnsOf(all, clusters, c).transpose());
      of_tile[t].noalias() += plane.template cast<float>().transpose() * lit;
    }
  });
  return addTiles(shape, of_tile);
}

}  // namespace

ColumnClusters clustersFromLabels(std::span<const std::uint32_t> labels, std::size_t clusters) {
  ColumnClusters out;
  out.first.assign(clusters + 1, 0);
  for (const std::uint32_t label : labels) {
    RELUME_CHECK_LT(label, clusters);
    ++out.first[label + 1];
  }
  std::partial_sum(out.first.begin(), out.first.end(), out.first.begin());
  out.column.resize(labels.size());
  std::vector<std::uint32_t> next(out.first.begin(), out.first.end() - 1);
  for (std::size_t i = 0; i < labels.size(); ++i)
    out.column[next[labels[i]]++] = static_cast<std::uint32_t>(i);
  return out;
}

EncodeReport sizesOf(const BlockMatrix& m) {
  EncodeReport out;
  out.bytes = m.bytes();
  out.plane_bytes = m.planes8.size() + 2 * m.planes16.size();
  out.weight_bytes = m.weights8.size() + 2 * m.weights16.size();
  out.index_bytes = out.bytes - out.plane_bytes - out.weight_bytes;
  if (m.rows > 0) out.overlap = static_cast<double>(m.tile_row.size()) / m.rows;
  for (std::size_t b = 0; b + 1 < m.component_first.size(); ++b) {
    const std::size_t rank = m.component_first[b + 1] - m.component_first[b];
    out.rank_count.resize(std::max(out.rank_count.size(), rank + 1));
    ++out.rank_count[rank];
  }
  return out;
}

EncodeError measureProducts(std::span<const float> given, std::span<const float> truth, std::size_t rows,
                            std::size_t channels) {
  const std::size_t size = rows * channels, lights = size == 0 ? 0 : truth.size() / size;
  EncodeError out;
  std::vector<float> of_light, of_row;
  std::vector<double> row_error(rows), row_total(rows);  // squared
  for (std::size_t l = 0; l < lights; ++l) {
    double error = 0, total = 0;
    for (std::size_t r = 0; r < rows; ++r) {
      row_error[r] = row_total[r] = 0;
      for (std::size_t i = l * size + r * channels; i < l * size + (r + 1) * channels; ++i) {
        const double off = static_cast<double>(given[i]) - truth[i];
        row_error[r] += off * off;
        row_total[r] += static_cast<double>(truth[i]) * truth[i];
      }
      error += row_error[r];
      total += row_total[r];
    }
    if (!(total > 0)) continue;
    of_light.push_back(static_cast<float>(std::sqrt(error / total)));
    const double least = kRowFloor * kRowFloor * total / static_cast<double>(rows);
    for (std::size_t r = 0; r < rows; ++r)
      of_row.push_back(static_cast<float>(std::sqrt(row_error[r] / std::max(row_total[r], least))));
  }
  if (of_light.empty()) return out;
  out.mean = std::accumulate(of_light.begin(), of_light.end(), 0.0) / static_cast<double>(of_light.size());
  out.worst = *std::max_element(of_light.begin(), of_light.end());
  out.median = quantile(of_light, 0.5);
  out.row_p95 = quantile(of_row, 0.95);
  return out;
}

EncodeError measure(const BlockMatrix& m, std::span<const float> x, std::span<const float> truth) {
  const std::size_t lights = m.columns == 0 ? 0 : x.size() / m.columns;
  RELUME_CHECK_EQ(truth.size(), lights * m.rows * m.channels);
  const std::vector<float> given = m.bits == 8 ? productsOf(m, m.planes8, m.weights8, x, lights)
                                               : productsOf(m, m.planes16, m.weights16, x, lights);
  return measureProducts(given, truth, m.rows, m.channels);
}

std::vector<float> products(const Transfer& transfer, std::span<const float> x) {
  const std::size_t lights = transfer.columns == 0 ? 0 : x.size() / transfer.columns;
  const Eigen::Map<const Matrix> given(x.data(), signedSize(lights), transfer.columns);
  std::vector<Matrix> of_tile(transfer.tiles.tiles());
  parallelFor(of_tile.size(), 1, [&](std::size_t t, std::size_t) {
    of_tile[t] = tileBlend(transfer, t).asDiagonal() * (tileRows(transfer, t) * given.transpose());
  });
  return addTiles(transfer, of_tile);
}

}  // namespace relume::codec
