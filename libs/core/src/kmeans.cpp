// SPDX-License-Identifier: MIT
#include "relume/core/kmeans.h"

#include <algorithm>
#include <limits>

#include "relume/core/check.h"
#include "relume/core/parallel.h"
#include "relume/core/sampling.h"

namespace relume {
namespace {

constexpr std::size_t kGrain = 256;  // points handed to a thread at a time

class Solver {
 public:
  Solver(std::span<const float> features, std::size_t dimensions, std::span<const float> weights,
         const KMeansOptions& options)
      : features_(features),
        dimensions_(dimensions),
        points_(features.size() / dimensions),
        weights_(weights) {
    out_.clusters = std::min(options.clusters, points_);
    out_.label.assign(points_, 0);
    out_.centre.resize(out_.clusters * dimensions);
    distance_.assign(points_, std::numeric_limits<float>::max());
  }

  KMeans solve(const KMeansOptions& options) {
    if (out_.clusters == 0) return out_;
    seed(options.seed);
    for (int i = 0; i < options.iterations; ++i) {
      const bool changed = assign();
      refill();
      moveCentres();
      if (!changed && i > 0) break;
    }
    return out_;
  }

 private:
  const float* point(std::size_t i) const { return &features_[i * dimensions_]; }
  float* centre(std::size_t c) { return &out_.centre[c * dimensions_]; }
  double weight(std::size_t i) const { return weights_.empty() ? 1.0 : weights_[i]; }

  float squaredDistance(const float* a, const float* b) const {
    float sum = 0;
    for (std::size_t d = 0; d < dimensions_; ++d) sum += (a[d] - b[d]) * (a[d] - b[d]);
    return sum;
  }

  void seed(std::uint32_t seed) {
    for (std::size_t c = 0; c < out_.clusters; ++c) {
      const std::size_t chosen = draw(sobol2(static_cast<std::uint32_t>(c), seed).x, c == 0);
      std::copy_n(point(chosen), dimensions_, centre(c));
      parallelFor(points_, kGrain, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i)
          distance_[i] = std::min(distance_[i], squaredDistance(point(i), centre(c)));
      });
    }
  }

  // A point by weight (the first), or by weight times squared distance to the centres so far.
  std::size_t draw(double u, bool first) const {
    const auto share = [&](std::size_t i) { return weight(i) * (first ? 1.0 : distance_[i]); };
    double total = 0;
    for (std::size_t i = 0; i < points_; ++i) total += share(i);
    double left = u * total;
    std::size_t last = 0;
    for (std::size_t i = 0; i < points_; ++i) {
      if (share(i) <= 0) continue;
      last = i;
      left -= share(i);
      if (left < 0) break;
    }
    return last;
  }

  // Every point to its nearest centre; true when one went to another.
  bool assign() {
    // Coordinates of centres side by side, so that distances to many are vector code.
    const std::size_t k = out_.clusters;
    std::vector<float> by_axis(k * dimensions_);
    for (std::size_t c = 0; c < k; ++c)
      for (std::size_t d = 0; d < dimensions_; ++d) by_axis[d * k + c] = centre(c)[d];
    const std::vector<std::uint32_t> before = out_.label;
    parallelFor(points_, kGrain, [&](std::size_t begin, std::size_t end) {
      std::vector<float> sum(k);
      for (std::size_t i = begin; i < end; ++i) {
        std::fill(sum.begin(), sum.end(), 0.0f);
        for (std::size_t d = 0; d < dimensions_; ++d) {
          const float x = point(i)[d];
          const float* axis = &by_axis[d * k];
          for (std::size_t c = 0; c < k; ++c) sum[c] += (axis[c] - x) * (axis[c] - x);
        }
        const auto nearest = std::min_element(sum.begin(), sum.end());
        out_.label[i] = static_cast<std::uint32_t>(nearest - sum.begin());
        distance_[i] = *nearest;
      }
    });
    return before != out_.label;
  }

  void refill() {
    std::vector<std::size_t> count(out_.clusters);
    for (const std::uint32_t label : out_.label) ++count[label];
    for (std::size_t c = 0; c < out_.clusters; ++c) {
      if (count[c] > 0) continue;
      std::size_t worst = points_;
      for (std::size_t i = 0; i < points_; ++i) {
        if (count[out_.label[i]] < 2) continue;  // the last of its cluster stays
        if (worst == points_ || weight(i) * distance_[i] > weight(worst) * distance_[worst]) worst = i;
      }
      --count[out_.label[worst]];
      ++count[c];
      out_.label[worst] = static_cast<std::uint32_t>(c);
      distance_[worst] = 0;
    }
  }

  void moveCentres() {
    std::vector<double> sum(out_.centre.size()), total(out_.clusters);
    for (std::size_t i = 0; i < points_; ++i) {
      const std::size_t c = out_.label[i];
      total[c] += weight(i);
      for (std::size_t d = 0; d < dimensions_; ++d) sum[c * dimensions_ + d] += weight(i) * point(i)[d];
    }
    for (std::size_t j = 0; j < sum.size(); ++j)
      out_.centre[j] = static_cast<float>(sum[j] / total[j / dimensions_]);
  }

  std::span<const float> features_;
  std::size_t dimensions_, points_;
  std::span<const float> weights_;
  KMeans out_;
  std::vector<float> distance_;  // squared, of each point to its centre
};

}  // namespace

KMeans kMeans(std::span<const float> features, std::size_t dimensions, std::span<const float> weights,
              const KMeansOptions& options) {
  RELUME_CHECK_LT(std::size_t{0}, dimensions);
  RELUME_CHECK_EQ(features.size() % dimensions, std::size_t{0});
  if (!weights.empty()) RELUME_CHECK_EQ(weights.size(), features.size() / dimensions);
  return Solver(features, dimensions, weights, options).solve(options);
}

}  // namespace relume
