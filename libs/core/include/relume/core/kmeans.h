// SPDX-License-Identifier: MIT
// Weighted k-means: parts points into clusters of small spread. Based on:
//   [Lloyd82] Lloyd. Least Squares Quantization in PCM. IEEE Trans. Information Theory 28(2), 1982.
//   [Arthur07] Arthur, Vassilvitskii. k-means++: The Advantages of Careful Seeding. SODA 2007.
#pragma once
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace relume {

struct KMeansOptions {
  std::size_t clusters = 8;  ///< at most the number of points; more are not made
  int iterations = 40;       ///< of Lloyd, at most; fewer where no point changes its cluster
  std::uint32_t seed = 1;
};

struct KMeans {
  std::vector<std::uint32_t> label;  ///< shape: [points]; every cluster has a point
  std::vector<float> centre;         ///< shape: [clusters][dimensions]; weighted mean of the cluster's points
  std::size_t clusters = 0;
};

/// Centres chosen one after the other with probability proportional to weight times squared distance to the
/// nearest so far ([Arthur07]), then points to the nearest centre and centres to the mean of their points in
/// turn ([Lloyd82]). A cluster left without points takes the point that adds most to the sum. Deterministic,
/// whatever the number of threads; costs points * clusters * dimensions for each iteration. features:
/// [points][dimensions], finite; weights: [points], positive, or empty for equal ones.
KMeans kMeans(std::span<const float> features, std::size_t dimensions, std::span<const float> weights,
              const KMeansOptions& options = {});

}  // namespace relume
