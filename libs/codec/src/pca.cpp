// SPDX-License-Identifier: MIT
// PCA through the Gram matrix. With X the data less its mean, G = X X^T (or X^T X, whichever is smaller) has
// the eigenvalues s_k^2 of X's singular values; components are B_k = X^T u_k / s_k, weights are X B^T. The
// squared error of the best rank D is sum_{k>D} s_k^2 (Eckart, Young 1936). Limits: eigenvalues of G carry an
// error of about 1e-16 of the largest, so directions below kMinVariance of it are noise.
#include "relume/codec/pca.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <numeric>

#include "relume/core/check.h"

namespace relume::codec {
namespace {

using Matrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
using FloatMap = Eigen::Map<const Eigen::Matrix<float, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>>;

constexpr double kMinVariance = 1e-12;
constexpr Eigen::Index kBlock = 1024;  // columns or rows taken to double at a time

// Lower triangle of the smaller Gram matrix.
Matrix gram(const FloatMap& data, const Eigen::RowVectorXd& mean, bool by_rows) {
  const Eigen::Index n = by_rows ? data.rows() : data.cols();
  const Eigen::Index length = by_rows ? data.cols() : data.rows();
  Matrix g = Matrix::Zero(n, n);
  for (Eigen::Index begin = 0; begin < length; begin += kBlock) {
    const Eigen::Index size = std::min(kBlock, length - begin);
    if (by_rows) {
      const Matrix x = data.middleCols(begin, size).cast<double>().rowwise() - mean.segment(begin, size);
      g.selfadjointView<Eigen::Lower>().rankUpdate(x);
    } else {
      const Matrix x = data.middleRows(begin, size).cast<double>().rowwise() - mean;
      g.selfadjointView<Eigen::Lower>().rankUpdate(x.transpose());
    }
  }
  return g;
}

// Rows become orthonormal; the second pass removes what rounding left of the first.
void orthonormalize(Matrix& rows) {
  for (Eigen::Index k = 0; k < rows.rows(); ++k) {
    for (int pass = 0; pass < 2; ++pass)
      for (Eigen::Index j = 0; j < k; ++j) rows.row(k) -= rows.row(k).dot(rows.row(j)) * rows.row(j);
    rows.row(k).normalize();
  }
}

void fixSigns(Matrix& rows) {
  for (Eigen::Index k = 0; k < rows.rows(); ++k) {
    Eigen::Index largest = 0;
    rows.row(k).cwiseAbs().maxCoeff(&largest);
    if (rows(k, largest) < 0) rows.row(k) = -rows.row(k);
  }
}

std::vector<float> toFloats(const Matrix& m) {
  std::vector<float> out(static_cast<std::size_t>(m.size()));
  std::transform(m.data(), m.data() + m.size(), out.begin(), [](double v) { return static_cast<float>(v); });
  return out;
}

}  // namespace

double Pca::error(std::size_t kept) const {
  // From the smallest, so that small terms are not lost.
  return std::accumulate(variance.rbegin(),
                         variance.rend() - static_cast<std::ptrdiff_t>(std::min(kept, variance.size())), 0.0);
}

void Pca::reconstruct(std::size_t row, std::span<float> out) const {
  RELUME_CHECK_LT(row, rows);
  RELUME_CHECK_EQ(out.size(), columns);
  std::copy(mean.begin(), mean.end(), out.begin());
  for (std::size_t k = 0; k < rank; ++k) {
    const float w = weights[row * rank + k];
    for (std::size_t c = 0; c < columns; ++c) out[c] += w * components[k * columns + c];
  }
}

Pca pca(std::span<const float> data, std::size_t rows, std::size_t columns, const PcaOptions& options) {
  RELUME_CHECK_EQ(data.size(), rows * columns);
  Pca result;
  result.rows = rows;
  result.columns = columns;
  result.mean.assign(columns, 0.0f);
  if (data.empty()) return result;

  const FloatMap matrix(data.data(), static_cast<Eigen::Index>(rows), static_cast<Eigen::Index>(columns));
  Eigen::RowVectorXd mean = Eigen::RowVectorXd::Zero(matrix.cols());
  if (options.remove_mean) {
    for (Eigen::Index r = 0; r < matrix.rows(); ++r) mean += matrix.row(r).cast<double>();
    mean /= static_cast<double>(rows);
    std::transform(mean.begin(), mean.end(), result.mean.begin(),
                   [](double v) { return static_cast<float>(v); });
  }

  const bool by_rows = rows <= columns;
  const Eigen::SelfAdjointEigenSolver<Matrix> solver(gram(matrix, mean, by_rows));
  const Eigen::Index n = solver.eigenvalues().size();
  for (Eigen::Index k = 0; k < n; ++k)
    result.variance.push_back(std::max(solver.eigenvalues()[n - 1 - k], 0.0));
  while (result.rank < std::min(options.rank, result.variance.size()) &&
         result.variance[result.rank] > kMinVariance * result.variance[0])
    ++result.rank;

  const auto rank = static_cast<Eigen::Index>(result.rank);
  const Matrix vectors = solver.eigenvectors().rightCols(rank).rowwise().reverse().transpose();  // [rank][n]
  Matrix components = vectors;
  if (by_rows) {
    components.resize(rank, matrix.cols());
    for (Eigen::Index begin = 0; begin < matrix.cols(); begin += kBlock) {
      const Eigen::Index size = std::min(kBlock, matrix.cols() - begin);
      const Matrix x = matrix.middleCols(begin, size).cast<double>().rowwise() - mean.segment(begin, size);
      components.middleCols(begin, size) = vectors * x;
    }
    orthonormalize(components);
  }
  fixSigns(components);
  result.components = toFloats(components);

  Matrix weights(matrix.rows(), rank);
  for (Eigen::Index r = 0; r < matrix.rows(); ++r)
    weights.row(r) = (matrix.row(r).cast<double>() - mean) * components.transpose();
  result.weights = toFloats(weights);
  return result;
}

}  // namespace relume::codec
