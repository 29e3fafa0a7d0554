// SPDX-License-Identifier: MIT
// Orthonormal basis of what matters in the range of a matrix, by random products.
#pragma once
#include <Eigen/Dense>
#include <cstdint>

namespace relume::codec {

using Matrix = Eigen::Matrix<float, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

struct RangeOptions {
  double tolerance = 0;  ///< stops when the squared norm of what is left is at most this
  Eigen::Index most_rank = 64;
  std::uint32_t seed = 1;
};

struct Range {
  Matrix basis;              ///< shape: [rank][rows of the matrix]; orthonormal, by falling variance
  Eigen::VectorXd variance;  ///< shape: [rank]; squared singular values
  double left = 0;           ///< squared norm of the matrix less its projection on the basis
};

/// Left singular vectors of the largest singular values of `a`, found in steps of 16 by random products and
/// two power iterations each, on what the steps before left ([Halko11], algorithm 4.4 and section 4.4);
/// single precision, so no more is found once 1e-7 of the squared norm are left. Deterministic.
Range range(const Eigen::Ref<const Matrix>& a, const RangeOptions& options);

}  // namespace relume::codec
