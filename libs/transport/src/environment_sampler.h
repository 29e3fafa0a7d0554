// SPDX-License-Identifier: MIT
// Directions to the environment in proportion to its radiance: rows by their mean, then pixels of the row
// (piecewise-constant two-dimensional inversion), weighted with the sine of the polar angle. A constant
// environment is sampled by the cosine to the receiver's normal. A pixel's weight is half its own and half
// the mean of its neighbourhood, so that the bilinear look-up is nowhere bright where the density is zero.
#pragma once
#include <vector>

#include "relume/scene/environment.h"

namespace relume::transport {

class EnvironmentSampler {
 public:
  /// Keeps a reference to the environment.
  explicit EnvironmentSampler(const scene::Environment& environment);

  /// Luminance of the mean radiance over the sphere.
  float meanLuminance() const { return mean_; }
  /// n: the receiver's normal, or zero for one that sees all around. u in [0, 1)^2.
  Direction sample(Normal n, Vec2 u) const;
  float pdf(Normal n, Direction d) const;  ///< per steradian

 private:
  const scene::Environment& environment_;
  float mean_ = 0;
  int width_ = 0, height_ = 0;
  std::vector<float> row_cdf_;     ///< shape: [height + 1]
  std::vector<float> column_cdf_;  ///< shape: [height][width + 1]
};

}  // namespace relume::transport
