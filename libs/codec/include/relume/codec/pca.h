// SPDX-License-Identifier: MIT
// Principal component analysis of a tall or wide data matrix, to optimal error.
// Based on:
//   [Eckart36] Eckart, Young. The approximation of one matrix by another of lower rank. Psychometrika 1,
//   1936.
#pragma once
#include <cstddef>
#include <span>
#include <vector>

namespace relume::codec {

struct PcaOptions {
  std::size_t rank = 8;  ///< components wanted; fewer come back where the data has fewer
  bool remove_mean = true;
};

/// data[i] ~ mean + sum_k weights[i][k] components[k].
struct Pca {
  std::size_t rows = 0, columns = 0;
  std::size_t rank = 0;     ///< components kept, <= PcaOptions::rank
  std::vector<float> mean;  ///< shape: [columns]; zero where the mean was not removed
  /// shape: [rank][columns]; orthonormal, by falling variance; the entry of largest magnitude is positive
  std::vector<float> components;
  std::vector<float> weights;    ///< shape: [rows][rank]
  std::vector<double> variance;  ///< shape: [min(rows, columns)]; squared singular values, falling

  /// Squared Frobenius norm of what the first `kept` components leave out: the sum of the remaining variance
  /// ([Eckart36]).
  double error(std::size_t kept) const;
  /// Row i rebuilt. out: [columns]
  void reconstruct(std::size_t row, std::span<float> out) const;
};

/// data: [rows][columns]. Works in double through the smaller Gram matrix, min(rows, columns)^2 * 8 bytes.
/// Squaring loses directions whose singular value is below 1e-6 of the largest: those are not kept.
/// Deterministic.
Pca pca(std::span<const float> data, std::size_t rows, std::size_t columns, const PcaOptions& options = {});

}  // namespace relume::codec
