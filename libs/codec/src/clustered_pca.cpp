// SPDX-License-Identifier: MIT
// With X the columns of a cluster less their mean, the eigenvectors u_k of the small scatter matrix X^T X
// give the planes B_k = X u_k / s_k and the weights s_k u_k ([Umenhoffer] section 7.3; by the small matrix
// instead of that over texels). Centring needs no second pass: X^T X = J T^T T J with J = 1 - 1 1^T / n.
#include "clustered_pca.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "relume/core/parallel.h"

namespace relume::codec {
namespace {

using Eigen::Index;
using MatrixD = Eigen::MatrixXd;

constexpr std::size_t kGroup = 8;       // tiles read at a time
constexpr double kMinVariance = 1e-12;  // of the largest in a cluster: below is rounding

// Tiles overlap; the first one that has a row owns it.
std::vector<std::vector<std::uint32_t>> ownedMembers(const Transfer& transfer) {
  std::vector<bool> taken(transfer.rows);
  std::vector<std::vector<std::uint32_t>> out(transfer.tiles.tiles());
  for (std::size_t t = 0; t < out.size(); ++t)
    for (std::size_t i = 0; i < transfer.tiles.rows(t); ++i) {
      const std::uint32_t row = transfer.tiles.row[transfer.tiles.first[t] + i];
      if (!taken[row]) out[t].push_back(static_cast<std::uint32_t>(i));
      taken[row] = true;
    }
  return out;
}

// Calls body(group of owned rows of tiles, first tile) with tiles read in parallel.
template <class Body>
void forTiles(const Transfer& transfer, Progress* progress, const Body& body) {
  const auto owned = ownedMembers(transfer);
  for (std::size_t begin = 0; begin < owned.size(); begin += kGroup) {
    std::vector<Matrix> group(std::min(kGroup, owned.size() - begin));
    parallelFor(
        group.size(), 1,
        [&](std::size_t g, std::size_t) {
          const Matrix all = tileRows(transfer, begin + g);
          const std::size_t rows = transfer.tiles.rows(begin + g), kept = owned[begin + g].size();
          group[g].resize(signedSize(transfer.channels * kept), all.cols());
          for (std::size_t c = 0; c < transfer.channels; ++c)
            for (std::size_t i = 0; i < kept; ++i)
              group[g].row(signedSize(c * kept + i)) = all.row(signedSize(c * rows + owned[begin + g][i]));
        },
        progress);
    for (std::size_t g = 0; g < group.size(); ++g) {
      std::vector<std::uint32_t> rows;
      for (const std::uint32_t i : owned[begin + g])
        rows.push_back(transfer.tiles.row[transfer.tiles.first[begin + g] + i]);
      body(group[g], rows);
    }
  }
}

}  // namespace

std::vector<PcaCluster> clusteredPca(const Transfer& transfer, const ColumnClusters& clusters,
                                     std::size_t rank, Progress* progress) {
  const std::size_t count = clusters.clusters();
  std::vector<MatrixD> scatter;
  for (std::size_t c = 0; c < count; ++c)
    scatter.push_back(MatrixD::Zero(signedSize(clusters.columns(c)), signedSize(clusters.columns(c))));
  forTiles(transfer, progress, [&](const Matrix& tile, const std::vector<std::uint32_t>&) {
    parallelFor(count, 1, [&](std::size_t c, std::size_t) {
      const MatrixD x = columnsOf(tile, clusters, c).cast<double>();
      scatter[c].selfadjointView<Eigen::Lower>().rankUpdate(x.transpose());
    });
  });

  std::vector<PcaCluster> out(count);
  std::vector<Matrix> directions(count);  // columns into mean and planes; shape: [columns][1 + planes]
  parallelFor(count, 1, [&](std::size_t c, std::size_t) {
    const Index n = scatter[c].rows();
    if (n == 0) return;
    MatrixD g = scatter[c].selfadjointView<Eigen::Lower>();
    g.rowwise() -= g.colwise().mean().eval();
    g.colwise() -= g.rowwise().mean().eval();
    const Eigen::SelfAdjointEigenSolver<MatrixD> solver(g);
    out[c].variance = solver.eigenvalues().reverse().cwiseMax(0);
    // Centring takes one dimension.
    Index kept = 0;
    while (kept < std::min(signedSize(rank), n - 1) &&
           out[c].variance[kept] > kMinVariance * scatter[c].trace())
      ++kept;
    out[c].weights = Matrix::Ones(1 + kept, n);
    directions[c] = Matrix::Constant(n, 1 + kept, 1 / static_cast<float>(n));
    for (Index k = 0; k < kept; ++k) {
      const double s = std::sqrt(out[c].variance[k]);
      const Eigen::VectorXd u = solver.eigenvectors().col(n - 1 - k);
      out[c].weights.row(1 + k) = (s * u).cast<float>().transpose();
      directions[c].col(1 + k) = (u / s).cast<float>();
    }
    out[c].planes.resize(1 + kept, signedSize(std::size_t{transfer.rows} * transfer.channels));
  });
  forTiles(transfer, progress, [&](const Matrix& tile, const std::vector<std::uint32_t>& rows) {
    parallelFor(count, 1, [&](std::size_t c, std::size_t) {
      if (directions[c].size() == 0) return;
      Matrix x = columnsOf(tile, clusters, c);
      const Eigen::VectorXf mean = x.rowwise().mean();
      x.colwise() -= mean;
      Matrix values = x * directions[c];
      values.col(0) = mean;
      for (std::size_t channel = 0; channel < transfer.channels; ++channel)
        for (std::size_t i = 0; i < rows.size(); ++i)
          out[c].planes.col(signedSize(channel * transfer.rows + rows[i])) =
              values.row(signedSize(channel * rows.size() + i)).transpose();
    });
  });
  return out;
}

}  // namespace relume::codec
