// SPDX-License-Identifier: MIT
#include "range.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "relume/core/sampling.h"

namespace relume::codec {
namespace {

constexpr Eigen::Index kStep = 16;
constexpr int kPowerIterations = 2;
constexpr double kNoise = 1e-7;  // of the squared norm: what single precision leaves

using Columns = Eigen::MatrixXf;  // column-major

Columns randomColumns(Eigen::Index rows, Eigen::Index columns, std::uint32_t seed) {
  Columns out(rows, columns);
  for (Eigen::Index c = 0; c < columns; ++c)
    for (Eigen::Index r = 0; r < rows; ++r) {
      // Box and Muller (1958).
      const std::uint32_t a =
          hashCombine(hashCombine(seed, static_cast<std::uint32_t>(c)), static_cast<std::uint32_t>(r));
      const std::uint32_t b = hashCombine(a, 1u);
      const double u = (a + 0.5) * 0x1p-32, v = b * 0x1p-32;
      out(r, c) = static_cast<float>(std::sqrt(-2 * std::log(u)) * std::cos(6.283185307179586 * v));
    }
  return out;
}

Columns orthonormal(const Columns& y) {
  const Eigen::HouseholderQR<Columns> qr(y);
  return qr.householderQ() * Columns::Identity(y.rows(), y.cols());
}

}  // namespace

Range range(const Eigen::Ref<const Matrix>& a, const RangeOptions& options) {
  const Eigen::Index full = std::min(a.rows(), a.cols());
  const double norm = a.cast<double>().squaredNorm();
  double left = norm;
  Columns q(a.rows(), 0);  // orthonormal columns
  Matrix b(0, a.cols());   // q^T a
  while (q.cols() < std::min(options.most_rank, full) && left > std::max(options.tolerance, kNoise * norm)) {
    const Eigen::Index known = q.cols(), step = std::min(kStep, full - known);
    const auto deflate = [&](Columns y) {
      // Twice: what rounding left of the first is large beside a residual of 1e-3.
      for (int pass = 0; pass < 2 && known > 0; ++pass) y -= (q * (q.transpose() * y)).eval();
      return y;
    };
    Columns y = orthonormal(deflate(
        a * randomColumns(a.cols(), step, hashCombine(options.seed, static_cast<std::uint32_t>(known)))));
    for (int i = 0; i < kPowerIterations; ++i) {
      const Columns z = orthonormal(a.transpose() * y);
      y = orthonormal(deflate(a * z));
    }
    y = orthonormal(deflate(std::move(y)));
    q.conservativeResize(Eigen::NoChange, known + step);
    q.rightCols(step) = y;
    b.conservativeResize(known + step, Eigen::NoChange);
    b.bottomRows(step) = y.transpose() * a;
    left -= b.bottomRows(step).cast<double>().squaredNorm();
  }

  Range out;
  out.left = std::max(left, 0.0);
  // The last step has more than asked for, which makes what is kept of it better.
  const Eigen::Index rank = std::min(q.cols(), options.most_rank);
  if (rank == 0) return out;
  const Eigen::MatrixXd wide = b.cast<double>();
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(wide * wide.transpose());
  const Eigen::VectorXd variance = solver.eigenvalues().reverse().cwiseMax(0);
  out.variance = variance.head(rank);
  out.left += variance.tail(variance.size() - rank).sum();
  out.basis = (q * solver.eigenvectors().rightCols(rank).rowwise().reverse().cast<float>()).transpose();
  return out;
}

}  // namespace relume::codec
