// SPDX-License-Identifier: MIT
// One block of a matrix as rounded components, each of which mends what rounding the ones before it did.
#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "range.h"

namespace relume::codec {

/// Components of a block in the order in which they are worth most.
struct BlockCode {
  std::vector<float> scale;           ///< shape: [components]
  std::vector<std::int16_t> planes;   ///< shape: [components][height]; in [-max, max]
  std::vector<std::int16_t> weights;  ///< shape: [components][width]; companded, in [-max, max]
  /// Squared error of each light's product with the first k components, then of the plain matrix, and last
  /// the relative squared error of products; shape: [components + 1][lights + 2]
  std::vector<float> left;
  std::vector<double>
      unrounded_left;  ///< weighed squared error with as many exact components; [components + 1]
  std::size_t components() const { return scale.size(); }
};

/// What a block is multiplied with, and how much errors of that count.
struct BlockLights {
  Eigen::Ref<const Matrix> lights;  ///< shape: [lights][width]
  double plain = 0;                 ///< weight of the squared error of the matrix itself
  /// How much each product counts in the relative error; shape: [height][lights]
  Eigen::Ref<const Matrix> relative;
};

struct BlockOptions {
  double tolerance = 0;  ///< of the weighed squared error; no more components than it takes
  Eigen::Index most_rank = 64;
  int max = 127;  ///< largest sample
  std::uint32_t seed = 1;
};

/// Minimizes ||lights (block - approximation)^T||^2 + plain ||block - approximation||^2. block:
/// [height][width]
BlockCode encodeBlock(Matrix block, const BlockLights& lights, const BlockOptions& options);

/// Rounds values to q with sign(q) (q / max)^2 * scale nearest; returns the scale.
float roundWeights(std::span<const float> values, int max, std::span<std::int16_t> out);
/// Rounds values to q with q * scale nearest; returns the scale.
float roundPlane(std::span<const float> values, int max, std::span<std::int16_t> out);

}  // namespace relume::codec
