// SPDX-License-Identifier: MIT
#include "relume/codec/encode_clustered_pca.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "block_encoder.h"
#include "clustered_pca.h"
#include "relume/core/check.h"
#include "relume/core/parallel.h"

namespace relume::codec {
namespace {

using Eigen::Index;

constexpr int kBisections = 14;

BlockMatrix rounded(const Transfer& transfer, const ColumnClusters& clusters,
                    const std::vector<PcaCluster>& pca, const std::vector<Index>& planes,
                    std::uint32_t bits) {
  BlockMatrix out;
  out.rows = transfer.rows;
  out.columns = transfer.columns;
  out.channels = transfer.channels;
  out.bits = bits;
  out.tile_first = {0, transfer.rows};
  out.tile_row.resize(transfer.rows);
  std::iota(out.tile_row.begin(), out.tile_row.end(), 0u);
  out.cluster_first = clusters.first;
  out.cluster_column = clusters.column;
  out.component_first = {0};
  const int max = bits == 8 ? 127 : 32767;
  const auto append = [&](auto& eight, auto& sixteen, const std::vector<std::int16_t>& q) {
    if (bits == 8)
      std::transform(q.begin(), q.end(), std::back_inserter(eight),
                     [](std::int16_t v) { return static_cast<std::int8_t>(v); });
    else
      sixteen.insert(sixteen.end(), q.begin(), q.end());
  };
  for (std::size_t c = 0; c < pca.size(); ++c) {
    for (Index k = 0; k < planes[c]; ++k) {
      const auto rowOf = [k](const Matrix& m) {
        return std::span(m.row(k).data(), static_cast<std::size_t>(m.cols()));
      };
      std::vector<std::int16_t> plane(static_cast<std::size_t>(pca[c].planes.cols())),
          weight(clusters.columns(c));
      const float plane_scale = roundPlane(rowOf(pca[c].planes), max, plane);
      const float weight_scale = roundWeights(rowOf(pca[c].weights), max, weight);
      out.scale.push_back(plane_scale * weight_scale);
      append(out.planes8, out.planes16, plane);
      append(out.weights8, out.weights16, weight);
    }
    out.component_first.push_back(static_cast<std::uint32_t>(out.scale.size()));
  }
  return out;
}

class Encoder {
 public:
  Encoder(const Transfer& transfer, const ColumnClusters& clusters, const Lights& lights,
          const ClusteredPcaOptions& options, Progress* progress)
      : transfer_(transfer),
        clusters_(clusters),
        lights_(lights),
        options_(options),
        pca_(clusteredPca(transfer, clusters, options.rank, progress)),
        truth_(products(transfer, lights.held_out)) {}

  EncodedClusteredPca encode() const {
    EncodedClusteredPca out;
    // Planes, the mean among them, whose variance is at least so much; the mean stays in any case.
    double lo = std::numeric_limits<double>::max(), hi = 0;
    std::vector<Index> planes;
    for (const PcaCluster& c : pca_) {
      planes.push_back(c.planes.rows());
      if (c.variance.size() > 0 && c.variance[0] > 0) {
        hi = std::max(hi, c.variance[0]);
        lo = std::min(lo, std::max(c.variance[c.variance.size() - 1], 1e-12 * c.variance[0]));
      }
    }
    out.matrix = rounded(transfer_, clusters_, pca_, planes, options_.bits);
    if (options_.error > 0 && error(out.matrix).mean <= options_.error) {
      for (int i = 0; i < kBisections && lo < hi; ++i) {
        const double middle = std::sqrt(lo) * std::sqrt(hi);
        for (std::size_t c = 0; c < pca_.size(); ++c) {
          planes[c] = std::min<Index>(1, pca_[c].planes.rows());
          while (planes[c] < pca_[c].planes.rows() && pca_[c].variance[planes[c] - 1] >= middle) ++planes[c];
        }
        BlockMatrix m = rounded(transfer_, clusters_, pca_, planes, options_.bits);
        if (error(m).mean <= options_.error) {
          out.matrix = std::move(m);
          lo = middle;
        } else {
          hi = middle;
        }
      }
    }
    out.report = sizesOf(out.matrix);
    out.report.error = error(out.matrix);
    out.report.met = options_.error <= 0 || out.report.error.mean <= options_.error;
    for (const PcaCluster& c : pca_) {
      out.optimal_error.emplace_back();
      for (Index d = 0; d < c.variance.size(); ++d)
        out.optimal_error.back().push_back(c.variance.tail(c.variance.size() - d).sum());
    }
    return out;
  }

 private:
  EncodeError error(const BlockMatrix& m) const { return measure(m, lights_.held_out, truth_); }

  const Transfer& transfer_;
  const ColumnClusters& clusters_;
  const Lights& lights_;
  ClusteredPcaOptions options_;
  std::vector<PcaCluster> pca_;
  std::vector<float> truth_;  // shape: [held-out lights][rows][channels]
};

}  // namespace

EncodedClusteredPca encodeClusteredPca(const Transfer& transfer, const ColumnClusters& clusters,
                                       const Lights& lights, const ClusteredPcaOptions& options,
                                       Progress* progress) {
  RELUME_CHECK(options.bits == 8 || options.bits == 16);
  return Encoder(transfer, clusters, lights, options, progress).encode();
}

}  // namespace relume::codec
